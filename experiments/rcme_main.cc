// rcme: statistical validation of robust two-view motion estimators.

#include "experiments/program.h"

int main(int argc, char** argv) { return rcme::RunProgram(argc, argv); }
