#include "experiments/commands/lock_option.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

#include "experiments/core/files/shared_files.h"
#include "experiments/core/text/message.h"
#include "experiments/study/study_lock.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"

namespace rcme {

void AddLockOptions(CLI::App* command, LockArguments* arguments) {
  command->add_option("--lock", arguments->file,
                      "lock file of `rcme lock`; default: the one beside the study, if there is one");
  command->add_option(
      "--despite-lock", arguments->despite,
      "REASON: run although the study departs from its lock; the result file keeps the reason");
}

std::string FindStudyFile(const std::string& study) {
  return FindFile(study, SharedFolder::kStudies, {"study file", "a study"});
}

std::string FindLock(const std::string& study, const LockArguments& arguments) {
  if (!arguments.file.empty()) return arguments.file;
  const std::string beside = PathOfLockBeside(FindStudyFile(study));
  return std::filesystem::exists(beside) ? beside : "";
}

void TakeLock(const std::string& study, const LockArguments& arguments, const std::string& stopping_rule,
              StudyPlan* plan) {
  const std::string& reason = arguments.despite;
  if (FindNotInLine(reason) != std::string::npos)
    throw InputError(fmt::format("--despite-lock: {} is not allowed; give one line of text", Quoted(reason)));
  const std::string path = FindLock(study, arguments);
  if (path.empty()) {
    if (reason.empty()) return;
    throw InputError(fmt::format("--despite-lock: {} has no lock; leave it out, or give --lock", study));
  }
  const std::string text = ReadLockFile(path);
  const StudyLock lock = ParseLock(text, path);
  const std::vector<std::string> deviations =
      DeviationsFrom(lock, plan->study_yaml, plan->identity, stopping_rule);
  if (!deviations.empty() && reason.empty()) {
    throw InputError(
        fmt::format("{}: was locked in {}, and now says something else: {}. Run it as it was locked, or give "
                    "a reason with "
                    "--despite-lock, which the result file keeps",
                    study, path, fmt::join(deviations, "; ")));
  }
  plan->lock = text;
  if (!deviations.empty()) plan->despite_lock = reason;
  PrintMessage("{}: locked at {}, SHA-256 {}\n", path, lock.locked_at, lock.sha256);
  for (const std::string& deviation : deviations) PrintMessage("  despite the lock: {}\n", deviation);
}

}  // namespace rcme
