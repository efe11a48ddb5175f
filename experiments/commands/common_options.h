// Options shared by several commands.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace rcme {

// The required argument: a study file, or the name of an installed study.
CLI::Option* AddStudyArgument(CLI::App* command, std::string* study);

// --threads, from 0 (one per core) to 1024. `what` says how the result depends on it.
CLI::Option* AddThreadsOption(CLI::App* command, int* threads,
                              const std::string& what = "Results do not depend on it");

// --seed, at least 0, with its default in the help. `of` says what it seeds: "the random samples".
CLI::Option* AddSeedOption(CLI::App* command, std::int64_t* seed,
                           const std::string& of = "the random samples");

// --estimators LABEL,..., for commands that take several; those that take one have --estimator.
CLI::Option* AddEstimatorsOption(CLI::App* command, std::vector<std::string>* labels,
                                 const std::string& what = "labels a,b,... of estimators; default: all");

// --sigma in px, with its default in the help: the noise that an estimator assumes.
CLI::Option* AddSigmaOption(CLI::App* command, std::optional<double>* sigma_px);

}  // namespace rcme
