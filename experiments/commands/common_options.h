// Options shared by several commands, and validators of options.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "experiments/core/table/command_result.h"
#include "experiments/study/estimator_spec.h"
#include "experiments/study/study.h"
#include "parameters/parameter.h"
#include "parameters/suggestion.h"

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

// --noise, after --sigma, in whose place it is given: a file of `rcme calibrate-noise`.
CLI::Option* AddNoiseFileOption(CLI::App* command, std::string* path);

// --condition and --trial, both required: one trial of a study or a run.
void AddTrialChoice(CLI::App* command, std::uint32_t* condition, std::uint32_t* trial);

// --allow-process, for all commands that call estimators (study/command_permission.h).
void AddProcessOption(CLI::App* command, bool* is_allowed);

// Allows the commands that estimators from files name, and prints them on standard error.
void AllowAndSay(std::vector<EstimatorSpec>* estimators);

// --format, for the commands that report a result; the initial value of `format` is the default.
CLI::Option* AddFormatOption(CLI::App* command, std::string* format);

// Prints the result in the format to standard output, or writes it to the file `out` if that is not empty.
void PrintResult(const CommandResult& result, const std::string& format, const std::string& out = "");

// Writes `stem`.txt, .csv and .json.
void WriteResultFiles(const CommandResult& result, const std::string& stem);

// --max-time, for commands whose work can be resumed. `pieces` names the items between which the command can
// stop: "trials". An empty time is no limit.
CLI::Option* AddTimeLimit(CLI::App* command, const std::string& pieces, std::string* max_time);

// Starts the clock. Call it while a StopOnSignals exists (core/work/stop_request.h).
void StartTimeLimit(const std::string& max_time);

// Parses "1,5": the bounds on the rotation and direction errors, deg. Throws InputError that names --bounds
// and the allowed values.
FailureBounds ParseFailureBounds(const std::string& text);

// Validates numbers with the same syntax as in files (whole text, decimal, finite). `parse` reads a whole
// text into a Number and returns false if it is not a number. `allowed` describes the allowed values in
// words.
template <typename Number>
CLI::Validator NumberValidator(bool (*parse)(const std::string&, Number*), Number min, Number max,
                               const std::string& allowed) {
  const auto check = [=](std::string& text) -> std::string {
    Number value{};
    if (!parse(text, &value) || value < min || value > max)
      return fmt::format("'{}' is not allowed; give {}", text, allowed);
    text = fmt::format("{}", value);
    return {};
  };
  return {check, allowed};
}

// The validators of numbers are for Option::transform: they pass the number on in plain decimal, 10 for 010.
inline CLI::Validator WholeNumberIn(std::int64_t min,
                                    std::int64_t max = std::numeric_limits<std::int64_t>::max()) {
  return NumberValidator<long long>(ParseInteger, min, max,
                                    fmt::format("a whole number in [{}, {}]", min, max));
}

// For Option::check: the value must be one of `words`.
inline CLI::Validator MakeChoiceValidator(const std::vector<std::string>& words) {
  const std::string allowed = fmt::format("{}", fmt::join(words, ", "));
  const auto check = [=](const std::string& text) -> std::string {
    if (std::ranges::count(words, text) > 0) return {};
    return fmt::format("'{}' is not allowed{}; give one of: {}", text, DidYouMean(text, words), allowed);
  };
  return {check, "{" + fmt::format("{}", fmt::join(words, ",")) + "}"};
}

inline CLI::Validator NumberIn(Parameter::Range range = {}) {
  return NumberValidator<double>(ParseReal, range.min, range.max,
                                 Parameter::Real("", nullptr, range, "", "").allowed());
}

}  // namespace rcme
