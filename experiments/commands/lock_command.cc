#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/lock_option.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/text/message.h"
#include "experiments/core/text/shell_word.h"
#include "experiments/study/study_file.h"
#include "experiments/study/study_lock.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

struct LockCommandArguments {
  std::string study, out;  // out empty: beside the study
};

// Throws InputError for an installed study: the folder beside it belongs to everybody.
std::string ChooseLockPath(const LockCommandArguments& arguments, const std::string& path) {
  if (!arguments.out.empty()) return arguments.out;
  if (path == arguments.study) return PathOfLockBeside(path);
  throw InputError(
      fmt::format("{}: is installed for everybody, and a lock beside it would hold for all; copy {} and lock "
                  "the copy, or give --out",
                  arguments.study, path));
}

// The command that runs the study with the lock.
std::string FormatRunCommand(const LockCommandArguments& arguments, const std::string& path,
                             const std::string& lock) {
  const std::string command = "rcme run " + QuoteForShell(arguments.study);
  return lock == PathOfLockBeside(path) ? command : command + " --lock " + QuoteForShell(lock);
}

void Lock(const LockCommandArguments& arguments) {
  const std::string path = FindStudyFile(arguments.study);
  const std::string out = ChooseLockPath(arguments, path);
  if (std::filesystem::exists(out)) {
    throw InputError(
        fmt::format("{}: exists already, and a lock is made once; remove it, or give another --out", out));
  }
  const Study study = LoadStudy(arguments.study);
  if (!study.ademp)
    throw InputError(
        fmt::format("{}: key 'ademp' is missing: a lock holds aims, data, estimands, methods and "
                    "performance (rcme list keys)",
                    path));
  const StudyLock lock = MakeLock(MakePlan(study, path, PlanEstimators::kNotMade));
  WriteFileWhole(out, ToYaml(lock));
  fmt::print("{}\n", lock.sha256);
  PrintMessage(
      "done: {}: {} hypotheses, {} trials per condition, seed {}; publish the hash above, then: {}\n", out,
      study.hypotheses.size(), study.trials, study.seed, FormatRunCommand(arguments, path, out));
}

}  // namespace

void AddLockCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("lock", "Write down what a study says, with its hash, before its run");
  command->footer(R"(The lock holds the study in full: its ADEMP block, seed, trials, conditions, estimators,
failure bounds and hypotheses with their margins, and the SHA-256 of that text, which is
printed. `rcme run` finds the lock beside the study and refuses a study that says
something else, with what differs; --despite-lock REASON runs it and keeps the reason.
`rcme summarize` and `rcme report` then say what was decided before the run and what
after, and `rcme check` verifies the hash.

The hash shows that the text is the one that was locked. It does not show when: give it
to somebody else before the run, in a commit or a letter.

Examples:
  rcme lock study.yaml                              writes study.lock
  rcme lock own_camera --out mine.lock              an installed study: name the lock
  rcme run study.yaml --out run.sqlite
  rcme run study.yaml --trials 500 --despite-lock "the intervals were too wide" --out more.sqlite
  rcme summarize run.sqlite)");
  auto arguments = std::make_shared<LockCommandArguments>();
  AddStudyArgument(command, &arguments->study);
  command->add_option(
      "-o,--out", arguments->out,
      "lock file to write; default: STUDY.lock beside the study; an installed study needs it");
  command->callback([arguments] { Lock(*arguments); });
}

}  // namespace rcme
