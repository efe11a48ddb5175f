#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/lock_option.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/text/message.h"
#include "experiments/study/study_file.h"
#include "experiments/study/study_lock.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

struct LockCommandArguments {
  std::string study, out;  // out empty: beside the study
};

void Lock(const LockCommandArguments& arguments) {
  const std::string path = FindStudyFile(arguments.study);
  const std::string out = arguments.out.empty() ? PathOfLockBeside(path) : arguments.out;
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
      "done: {}: {} hypotheses, {} trials per condition, seed {}; publish the hash above, then: rcme "
      "run {}\n",
      out, study.hypotheses.size(), study.trials, study.seed, arguments.study);
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
  rcme run study.yaml --out run.sqlite
  rcme run study.yaml --trials 500 --despite-lock "the intervals were too wide" --out more.sqlite
  rcme summarize run.sqlite)");
  auto arguments = std::make_shared<LockCommandArguments>();
  AddStudyArgument(command, &arguments->study);
  command->add_option("-o,--out", arguments->out, "lock file to write; default: STUDY.lock beside the study");
  command->callback([arguments] { Lock(*arguments); });
}

}  // namespace rcme
