#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <vector>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/lock_option.h"
#include "experiments/core/text/message.h"
#include "experiments/core/text/shell_word.h"
#include "experiments/core/work/for_each_index.h"
#include "experiments/core/work/progress.h"
#include "experiments/core/work/stop_request.h"
#include "experiments/run/run_study.h"
#include "experiments/study/study_file.h"
#include "experiments/trial/simulate_draw.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"

namespace rcme {
namespace {

struct ImportArguments {
  std::vector<std::string> answers, labels;
  std::string study, out;
  int threads = 0;
  bool allow_process = false;
  LockArguments lock;
};

EstimatorSpec SpecOfAnswers(const std::string& path, const std::string& label) {
  EstimatorSpec spec{label, "answers", {}, {}};
  SetOptions(&spec, AnswersOptions(path));
  return spec;
}

// Counts the trials that have no answer.
std::int64_t CountMissing(const ResultStore& store, size_t estimator) {
  std::int64_t count = 0;
  store.ForEachRecord([&](const TrialRecord& record) {
    count += record.estimator == estimator && record.status == MotionStatus::kNoAnswer;
  });
  return count;
}

// Whether each file of answers, the last estimators of the plan, has an answer to one of its problems.
using FilesWithAnswer = std::vector<std::atomic<bool>>;

void LookUp(const StudyPlan& plan, const Condition& condition, std::uint32_t trial, FilesWithAnswer* files) {
  const auto simulated =
      SimulateDraw(plan.study, [&] { return condition.source->Make(NameOfScene(plan, condition, trial)); });
  if (!simulated.made) return;
  const std::vector<std::shared_ptr<const MotionEstimator>>& estimators = FindEstimators(plan, condition);
  for (size_t i = 0; i < files->size(); ++i) {
    RandomStream rng = StreamFor(NameOfTrial(plan, condition, trial), StreamPurpose::kSampling);
    const MotionEstimator& answers = *estimators[estimators.size() - files->size() + i];
    if (answers.Estimate(simulated.made->problem, rng).status != MotionStatus::kNoAnswer) (*files)[i] = true;
  }
}

// Throws InputError for a file without an answer to a problem of the plan. Simulates problems until each file
// has one: usually the first.
void RequireAnswers(const ImportArguments& arguments, const StudyPlan& plan) {
  FilesWithAnswer files(arguments.answers.size());
  Progress progress("problems looked up in the answers", plan.NumTrials());
  for (const Condition& condition : plan.conditions) {
    ForEachIndex(condition.num_trials, arguments.threads, [&](std::int64_t trial) {
      if (std::find(files.begin(), files.end(), false) == files.end()) return;
      LookUp(plan, condition, static_cast<std::uint32_t>(trial), &files);
      progress.Advance(1);
    });
  }
  const auto without = std::find(files.begin(), files.end(), false);
  if (without == files.end()) return;
  throw InputError(fmt::format(
      "{}: holds no answer to a problem of {}; give the study.yaml that `rcme export` wrote beside the "
      "problems",
      arguments.answers[static_cast<size_t>(without - files.begin())], arguments.study));
}

void Import(const ImportArguments& arguments) {
  const StopOnSignals stop;
  if (arguments.labels.size() != arguments.answers.size()) {
    throw InputError(fmt::format("--label: {} labels for {} files of answers; give one for each file",
                                 arguments.labels.size(), arguments.answers.size()));
  }
  for (const std::string& label : arguments.labels) {
    if (label.empty() || FindNotInLine(label) != std::string::npos || label.find(',') != std::string::npos)
      throw InputError(
          fmt::format("--label: {} is not allowed; give one line of text without commas", Quoted(label)));
  }
  Study study = LoadStudy(arguments.study);
  if (arguments.allow_process) AllowAndSay(&study.estimators);
  const size_t num_own = study.estimators.size();
  for (size_t i = 0; i < arguments.answers.size(); ++i) {
    const std::string& label = arguments.labels[i];
    if (std::ranges::count(study.estimators, label, &EstimatorSpec::label) > 0)
      throw InputError(fmt::format("--label: the study has an estimator '{}' already; give another", label));
    study.estimators.push_back(SpecOfAnswers(arguments.answers[i], label));
  }
  StudyPlan plan = MakePlan(study, arguments.study);
  RequireAnswers(arguments, plan);
  LockArguments lock = arguments.lock;
  if (lock.despite.empty() && !FindLock(arguments.study, lock).empty())
    lock.despite = fmt::format("answers were imported: {}", fmt::join(arguments.labels, ", "));
  TakeLock(arguments.study, lock, "", &plan);
  ResultStore store = ResultStore::OpenForRun(arguments.out, plan);
  const RunReport report = RunStudy(plan, arguments.threads, &store);
  for (size_t i = 0; i < arguments.answers.size(); ++i) {
    const std::int64_t num_missing = CountMissing(store, num_own + i);
    if (num_missing > 0) {
      PrintMessage("warning: {}: {} of {} trials have no answer and get the status no_answer\n",
                   arguments.answers[i], num_missing, report.num_trials);
    }
  }
  PrintMessage("done: {} trials; next: rcme compare {}\n", report.num_trials, QuoteForShell(arguments.out));
}

}  // namespace

void AddImportCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "import", "Score answers from elsewhere beside a study's own estimators, on the same trials");
  command->footer(R"(Answers are lines of JSON with the id of their problem
(docs/estimators_in_any_language.md). The study is the one that `rcme export` wrote. A
problem without an answer gets the status no_answer; an answer that cannot be read gets
unreadable_answer.

Examples:
  rcme export failure_vs_outliers --trials 100 --out problems
  python3 mine.py < problems/problems.jsonl > answers.jsonl
  rcme import answers.jsonl --study problems/study.yaml --label mine --out run.sqlite
  rcme compare run.sqlite --against mine)");
  auto arguments = std::make_shared<ImportArguments>();
  command->add_option("answers", arguments->answers, "files of answers")->required();
  command->add_option("--study", arguments->study, "study.yaml of `rcme export`")->required();
  command
      ->add_option("--label", arguments->labels, "label of each file of answers, in their order; repeatable")
      ->required()
      ->allow_extra_args(false);
  command->add_option("-o,--out", arguments->out, "result file (SQLite)")->required();
  AddThreadsOption(command, &arguments->threads);
  AddProcessOption(command, &arguments->allow_process);
  AddLockOptions(command, &arguments->lock);
  command->callback([arguments] { Import(*arguments); });
}

}  // namespace rcme
