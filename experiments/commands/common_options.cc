#include "experiments/commands/common_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>

#include "experiments/core/files/file_output.h"
#include "experiments/core/text/duration.h"
#include "experiments/core/text/message.h"
#include "experiments/core/work/stop_request.h"
#include "experiments/study/command_permission.h"
#include "parameters/input_error.h"
#include "parameters/parameter.h"
#include "parameters/plain_text.h"

namespace rcme {

CLI::Option* AddStudyArgument(CLI::App* command, std::string* study) {
  return command
      ->add_option("study", *study,
                   "study file (YAML), or the name of an installed one (`rcme list studies`)")
      ->required();
}

CLI::Option* AddThreadsOption(CLI::App* command, int* threads, const std::string& what) {
  return command->add_option("--threads", *threads, "threads; 0: one per core. " + what)
      ->transform(WholeNumberIn(0, 1024));
}

CLI::Option* AddSeedOption(CLI::App* command, std::int64_t* seed, const std::string& of) {
  return command->add_option("--seed", *seed, "seed of " + of)
      ->transform(WholeNumberIn(0))
      ->capture_default_str();
}

CLI::Option* AddEstimatorsOption(CLI::App* command, std::vector<std::string>* labels,
                                 const std::string& what) {
  return command->add_option("--estimators,--estimator", *labels, what)
      ->delimiter(',')
      ->allow_extra_args(false);
}

CLI::Option* AddSigmaOption(CLI::App* command, std::optional<double>* sigma_px) {
  return command
      ->add_option(
          "--sigma", *sigma_px,
          "standard deviation of the noise per coordinate that the estimator assumes, px; default: the "
          "header '# sigma_px' of a match file, otherwise 0.5")
      ->transform(NumberIn({1e-9, 1000.0}));
}

CLI::Option* AddNoiseFileOption(CLI::App* command, std::string* path) {
  return command
      ->add_option("--noise", *path,
                   "a file of `rcme calibrate-noise`: its sigma in place of --sigma, its corrections of the "
                   "camera, and covariances for what it says is shared")
      ->excludes("--sigma");
}

void AddTrialChoice(CLI::App* command, std::uint32_t* condition, std::uint32_t* trial) {
  const CLI::Validator index = WholeNumberIn(0, std::numeric_limits<std::uint32_t>::max());
  command->add_option("--condition", *condition, "condition, from 0 (column condition of the summary)")
      ->transform(index)
      ->required();
  command->add_option("--trial", *trial, "trial, from 0")->transform(index)->required();
}

void AddProcessOption(CLI::App* command, bool* is_allowed) {
  command->add_flag("--allow-process", *is_allowed,
                    "run the commands of `process` estimators in files, after printing them; "
                    "without it such a file is refused (docs/threat_model.md)");
}

void AllowAndSay(std::vector<EstimatorSpec>* estimators) {
  for (const std::string& sentence : AllowCommands(estimators)) PrintMessage("{}\n", sentence);
}

CLI::Option* AddFormatOption(CLI::App* command, std::string* format) {
  return command
      ->add_option("--format", *format,
                   "of what is printed: table (for people), csv, json, latex (booktabs) or markdown")
      ->check(MakeChoiceValidator(ListResultFormats()))
      ->capture_default_str();
}

void PrintResult(const CommandResult& result, const std::string& format, const std::string& out) {
  PrintOrWrite(out, RenderResult(result, format));
}

void WriteResultFiles(const CommandResult& result, const std::string& stem) {
  WriteFileWhole(stem + ".txt", RenderResult(result, "table"));
  WriteFileWhole(stem + ".csv", RenderResult(result, "csv"));
  WriteFileWhole(stem + ".json", RenderResult(result, "json"));
}

CLI::Option* AddTimeLimit(CLI::App* command, const std::string& pieces, std::string* max_time) {
  return command
      ->add_option(
          "--max-time", *max_time,
          fmt::format(
              "stop after this time (55m, 1h30m, 90s), between two {}; exit code 75 if some are left: "
              "the same command resumes",
              pieces))
      ->check(ExplainDuration);
}

void StartTimeLimit(const std::string& max_time) {
  if (max_time.empty()) return;
  StopAfter(std::chrono::duration<double>(ParseDuration(max_time).value()));
}

FailureBounds ParseFailureBounds(const std::string& text) {
  const size_t comma = std::min(text.find(','), text.size());
  FailureBounds bounds;
  const auto is_angle = [](const std::string& part, double* angle) {
    return ParseReal(part, angle) && *angle > 0.0 && *angle <= 180.0;
  };
  if (comma < text.size() && is_angle(text.substr(0, comma), &bounds.max_rotation_error_deg) &&
      is_angle(text.substr(comma + 1), &bounds.max_direction_error_deg))
    return bounds;
  throw InputError(fmt::format(
      "--bounds: {} is not allowed; give R,D: a rotation and a direction in deg, above 0 and up to 180",
      Quoted(text)));
}

}  // namespace rcme
