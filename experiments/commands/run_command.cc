#include <fmt/format.h>

#include <memory>

#include "experiments/commands/commands.h"
#include "experiments/progress.h"
#include "experiments/run_study.h"
#include "experiments/study_file.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

struct RunArguments {
  std::string study, out;
  std::vector<std::string> overrides;
  std::int64_t trials = 0;
  std::int64_t seed = -1;
  int threads = 0;
};

Study StudyFrom(const RunArguments& arguments) {
  Study study = LoadStudy(arguments.study);
  for (const std::string& text : arguments.overrides) {
    const size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw InputError(fmt::format("--set: '{}' is not allowed; give key=value", text));
    }
    Override(&study, text.substr(0, equals), text.substr(equals + 1));
  }
  if (arguments.trials > 0) study.trials = static_cast<int>(arguments.trials);
  if (arguments.seed >= 0) study.seed = static_cast<std::uint64_t>(arguments.seed);
  return study;
}

// The plan of a study; what is wrong with the study as a whole names its file.
StudyPlan PlanOf(const Study& study, const std::string& path) {
  try {
    return MakePlan(study);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", path, error.what()));
  }
}

void Run(const RunArguments& arguments) {
  const StudyPlan plan = PlanOf(StudyFrom(arguments), arguments.study);
  ResultStore store = ResultStore::OpenForRun(arguments.out, plan);
  fmt::print(stderr, "{}: {} conditions, {} trials, {} estimators -> {}\n", plan.study.name,
             plan.conditions.size(), plan.NumTrials(), plan.estimators.size(), arguments.out);
  const RunReport report = RunStudy(plan, arguments.threads, &store);
  fmt::print(stderr, "done: {} trials ({} were there already) in {}; next: rcme summarize {}\n",
             report.num_trials, report.num_trials - report.num_run_now, DurationInWords(report.seconds),
             arguments.out);
}

}  // namespace

void AddRunCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand("run", "Run a study and keep every trial in a result file");
  auto arguments = std::make_shared<RunArguments>();
  command->add_option("study", arguments->study, "study file (YAML)")->required();
  command
      ->add_option("-o,--out", arguments->out,
                   "result file (SQLite); a run that was cut off is resumed, another study is refused")
      ->required();
  command
      ->add_option(
          "--set", arguments->overrides,
          "key=value, repeatable: a data key (sigma_px=1), an option of all estimators (mu=-2) or of one "
          "(rcme.mu=-2), or a failure bound")
      ->allow_extra_args(false);
  command->add_option("--trials", arguments->trials, "trials per condition; more than before extends a run")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{2'000'000'000}));
  command->add_option("--seed", arguments->seed, "seed of all random streams")
      ->check(CLI::Range(std::int64_t{0}, std::numeric_limits<std::int64_t>::max()));
  command
      ->add_option("--threads", arguments->threads,
                   "threads; 0: one per core. The results do not depend on it")
      ->check(CLI::Range(0, 1024));
  command->callback([arguments] { Run(*arguments); });
}

}  // namespace rcme
