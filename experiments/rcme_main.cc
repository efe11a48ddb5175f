// rcme: statistical validation of robust two-view motion estimators.

#include "experiments/program.h"
#include "peers/peer_registry.h"

int main(int argc, char** argv) {
  rcme::AddPeers();
  rcme::AddOutsideEstimators();
  return rcme::RunProgram(argc, argv);
}
