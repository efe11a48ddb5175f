#pragma once

namespace rcme {

// Where the installation that a program is built with keeps its studies, estimator files and plots:
// find_package(rcme) says so. Empty in the program `rcme` itself, which has them beside it
// (core/files/shared_files.h).
#ifdef RCME_INSTALLED_SHARE
constexpr const char* kInstalledShare = RCME_INSTALLED_SHARE;
#else
constexpr const char* kInstalledShare = "";
#endif

// The program `rcme` on a command line. Exit codes: 0 done, 2 usage or bad input, 130 and 143
// stopped by Ctrl-C and SIGTERM, 1 else; `rcme gate` has its own. A program of one's
// own that first calls AddEstimator (estimator_registry.h) has its estimator in every command;
// examples/own_estimator. What lies beside it goes before what lies in `installed_share`.
int RunProgram(int argc, const char* const* argv, const char* installed_share = kInstalledShare);

}  // namespace rcme
