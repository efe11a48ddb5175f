#pragma once

namespace rcme {

// The program `rcme` on a command line. Exit codes: 0 done, 2 usage or bad input, 130 and 143
// stopped by Ctrl-C and SIGTERM, 1 else. A program of one's
// own that first calls AddEstimator (estimator_registry.h) has its estimator in every command;
// examples/own_estimator.
int RunProgram(int argc, const char* const* argv);

}  // namespace rcme
