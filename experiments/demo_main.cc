// The program of scripts/demo, which builds in less time than `rcme`.

#include "experiments/commands/demo_commands.h"
#include "peers/peer_registry.h"

int main(int argc, char** argv) {
  rcme::AddPeers();
  rcme::AddOutsideEstimators();
  return rcme::RunDemoProgram(argc, argv);
}
