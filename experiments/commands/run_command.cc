#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/lock_option.h"
#include "experiments/commands/study_source.h"
#include "experiments/core/files/first_difference.h"
#include "experiments/core/table/render_table.h"
#include "experiments/core/table/table.h"
#include "experiments/core/text/json_output.h"
#include "experiments/core/text/message.h"
#include "experiments/core/text/shell_word.h"
#include "experiments/core/work/progress.h"
#include "experiments/core/work/stop_request.h"
#include "experiments/run/run_until.h"
#include "experiments/statistics/count_study.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

struct RunArguments {
  std::string study, out, format = "table";
  StudyChanges changes;
  LockArguments lock;
  std::int64_t trials = 0, repeats_per_scene = 0;  // 0: the study's own
  int threads = 0;
  std::string keep = "all";
  std::vector<std::string> retry;  // statuses
  std::string shard, max_time;     // empty: all of the study, no limit
  std::string until, until_event = "failure", merged;
  std::int64_t max_trials = UntilOptions{}.max_trials;
};

Study StudyFrom(const RunArguments& arguments) {
  Study study = LoadChangedStudy(arguments.study, arguments.changes);
  if (arguments.trials > 0) study.trials = static_cast<int>(arguments.trials);
  if (arguments.repeats_per_scene > 0)
    study.repeats_per_scene = static_cast<int>(arguments.repeats_per_scene);
  return study;
}

// Names of the statuses for a missing answer from outside the program, which may depend on the machine. An
// estimator would give any other status again.
std::map<std::string, MotionStatus> MissingAnswers() {
  std::map<std::string, MotionStatus> missing;
  for (const MotionStatus status :
       {MotionStatus::kNoAnswer, MotionStatus::kTimedOut, MotionStatus::kUnreadableAnswer})
    missing[StatusName(status)] = status;
  return missing;
}

std::vector<std::string> NamesOfMissingAnswers() {
  std::vector<std::string> names;
  for (const auto& [name, status] : MissingAnswers()) names.push_back(name);
  return names;
}

// Removes nothing if an estimator cannot be run again.
void RemoveForRetry(const StudyPlan& plan, const RunArguments& arguments, ResultStore* store) {
  CheckProcessEstimators(plan.study.estimators);
  const std::map<std::string, MotionStatus> missing = MissingAnswers();
  std::vector<MotionStatus> statuses;
  for (const std::string& name : arguments.retry) statuses.push_back(missing.at(name));
  const std::int64_t num_removed = store->RemoveForRetry(statuses);
  PrintMessage("--retry {}: {} trials are run again{}\n", fmt::join(arguments.retry, ","), num_removed,
               num_removed > 0 ? ", which the file notes" : "");
}

// Trials of every condition, with the estimator and the rate of its widest interval.
Table MakeSpentTable(const StudyPlan& plan, const std::vector<CellPrecision>& cells) {
  using C = const CellPrecision&;
  const auto levels_of = [&](C c) -> const auto& { return plan.conditions[c.condition].levels; };
  std::vector<ColumnOf<CellPrecision>> columns = LevelColumns<CellPrecision>(plan.factor_names, levels_of);
  Column estimator = Column::Text("estimator");
  estimator.heading = "widest interval";
  columns.push_back({Column::Count("trials"), [](C c) { return c.num_trials; }});
  columns.push_back({estimator, [&](C c) { return plan.study.estimators[c.estimator].label; }});
  columns.push_back({Column::Estimated("rate", {100.0, "%", ".3f"}), [](C c) {
                       return Estimate{c.rate, c.interval};
                     }});
  columns.push_back({Column::Text("target"), [](C c) { return c.is_reached ? "reached" : "not reached"; }});
  return MakeTable(columns, cells);
}

UntilOptions UntilOptionsFrom(const RunArguments& arguments) {
  UntilOptions options;
  options.target = PrecisionTarget::Parse(arguments.until);
  options.event = *std::ranges::find(TrialEvents(), arguments.until_event, &TrialEvent::name);
  options.max_trials = arguments.max_trials;
  options.num_threads = arguments.threads;
  return options;
}

// One shard's part of a round.
void RunRound(const StudyPlan& plan, const RunArguments& arguments, const Shard& shard, ResultStore* store) {
  std::optional<ResultStore> merged;
  if (!arguments.merged.empty()) {
    merged.emplace(ResultStore::OpenForReading(arguments.merged));
    const std::string identity = merged->Description().identity;
    if (identity != plan.identity) {
      throw InputError(fmt::format("--merged: {} is of another study; first difference: {}", arguments.merged,
                                   FirstDifference(identity, plan.identity)));
    }
  }
  if (RunRoundUntil(plan, UntilOptionsFrom(arguments), shard, merged ? &*merged : nullptr, store)) {
    PrintMessage(
        "the trials of shard {} in this round are done; next, when all shards are done: rcme merge\n",
        shard.Text());
    throw EndWith{kTryAgain};
  }
  PrintMessage("no trial is missing; next: the same command without --shard and --merged, with --out {}\n",
               arguments.merged);
}

void RunToPrecision(const StudyPlan& plan, const RunArguments& arguments, ResultStore* store) {
  const std::vector<CellPrecision> cells = RunUntil(plan, UntilOptionsFrom(arguments), store);
  std::int64_t spent = 0, num_open = 0;
  for (const CellPrecision& cell : cells) {
    spent += cell.num_trials;
    num_open += !cell.is_reached;
  }
  store->NoteUntilOptions(fmt::format("--until {} --until-event {} --max-trials {}", arguments.until,
                                      arguments.until_event, arguments.max_trials),
                          spent);
  const Table table = MakeSpentTable(plan, cells);
  std::string text = fmt::format("Trials spent until {} of {} (anytime-valid 95 %): {}\n\n{}",
                                 arguments.until, arguments.until_event, spent, RenderText(table));
  if (num_open > 0) {
    text += fmt::format("\n{} of {} conditions did not reach it within --max-trials {}\n", num_open,
                        cells.size(), arguments.max_trials);
  }
  const Facts facts = {{"study", plan.study.name},           {"file", arguments.out},
                       {"until", arguments.until},           {"event", arguments.until_event},
                       {"max_trials", arguments.max_trials}, {"trials", spent}};
  PrintResult(MakeResult(text, kRunFormat, facts, WithIntervalColumns(table)), arguments.format);
}

// Summary of the run for programs; for people its messages say the same.
CommandResult MakeRunResult(const StudyPlan& plan, const RunReport& report, const std::string& file) {
  Table table{{Column::Key("study"), Column::Count("conditions"), Column::Count("estimators"),
               Column::Count("trials"), Column::Count("trials_before"), Column::Number("seconds"),
               Column::Text("file")}};
  table.rows.push_back({plan.study.name, std::ssize(plan.conditions), std::ssize(plan.estimators),
                        report.num_trials, report.num_trials - report.num_run_now, report.seconds, file});
  return MakeResult("", kRunFormat, {}, table);
}

void Run(const RunArguments& arguments) {
  const StopOnSignals stop;
  StartTimeLimit(arguments.max_time);
  const Shard shard = arguments.shard.empty() ? Shard() : ParseShard(arguments.shard, ThisEnvironment());
  StudyPlan plan = MakePlan(StudyFrom(arguments), arguments.study);
  TakeLock(arguments.study, arguments.lock, arguments.until.empty() ? "" : "--until " + arguments.until,
           &plan);
  const bool keeps_counts = arguments.keep == "counts";
  if (keeps_counts && !arguments.retry.empty())
    throw InputError(
        "--retry does not work with --keep counts: counts do not tell which trials to run again");
  if (!arguments.until.empty()) CheckTrialsAreNew(plan);
  std::optional<ResultStore> store;
  if (!keeps_counts) store.emplace(ResultStore::OpenForRun(arguments.out, plan, shard));
  if (!arguments.retry.empty()) RemoveForRetry(plan, arguments, &*store);
  PrintMessage("{}: {} conditions, {} trials, {} estimators{} -> {}\n", plan.study.name,
               plan.conditions.size(), plan.NumTrials(), plan.estimators.size(),
               shard.count > 1 ? ", of which shard " + shard.Text() : "", arguments.out);
  const std::string population = DescribePopulation(plan.identity);
  if (!population.empty()) PrintMessage("{}\n", population);
  if (!arguments.until.empty() && shard.count > 1) return RunRound(plan, arguments, shard, &*store);
  if (!arguments.until.empty()) return RunToPrecision(plan, arguments, &*store);
  const RunReport report = keeps_counts ? CountStudy(plan, arguments.threads, arguments.out, shard)
                                        : RunStudy(plan, arguments.threads, &*store, shard);
  const bool is_of_real_pairs = plan.conditions.front().source->SharedScene().has_value();
  const std::string next = shard.count > 1 ? "rcme merge " + QuoteForShell(arguments.out)
                           : is_of_real_pairs && !keeps_counts
                               ? fmt::format("rcme summarize {0} (or, by scene, rcme paper-table {0})",
                                             QuoteForShell(arguments.out))
                               : "rcme summarize " + QuoteForShell(arguments.out);
  PrintMessage("done: {} trials ({} were there already) in {}; next: {}\n", report.num_trials,
               report.num_trials - report.num_run_now, DescribeDuration(report.seconds), next);
  PrintResult(MakeRunResult(plan, report, arguments.out), arguments.format);
}

}  // namespace

void AddRunCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand("run", "Run a study and keep every trial in a result file");
  command->footer(R"(Every trial is a function of the seed, its condition and its number: equal runs give
equal numbers, whatever the number of threads. A run that was stopped or killed goes on
with the same command.

Examples:
  rcme run failure_vs_outliers --trials 100 --out run.sqlite
  rcme run study.yaml --set outlier_ratio=0.4 --add-estimator mine.yaml --out run.sqlite
  rcme run study.yaml --until ci=0.01 --max-time 1h --out run.sqlite
  rcme run study.yaml --shard 3/64 --out part_3.sqlite       one share; then rcme merge
  rcme summarize run.sqlite)");
  auto arguments = std::make_shared<RunArguments>();
  AddStudyArgument(command, &arguments->study);
  command
      ->add_option("-o,--out", arguments->out,
                   "result file (SQLite); resumes an unfinished run, refuses a file of another study")
      ->required();
  AddStudyOptions(command, &arguments->changes);
  AddProcessOption(command, &arguments->changes.allow_process);
  AddLockOptions(command, &arguments->lock);
  AddFormatOption(command, &arguments->format);
  CLI::Option* trials =
      command
          ->add_option("--trials", arguments->trials, "trials per condition; a greater number extends a run")
          ->transform(WholeNumberIn(1, 2'000'000'000));
  CLI::Option* repeats =
      command
          ->add_option("--repeats-per-scene", arguments->repeats_per_scene,
                       "number of consecutive trials that share a scene with its noise and outliers; "
                       "`rcme summarize` then separates the variance between scenes from that of the sampler")
          ->transform(WholeNumberIn(1, kMaxRepeatsPerScene));
  CLI::Option* until =
      command
          ->add_option("--until", arguments->until,
                       "add trials to each condition until every estimator's 95 % interval is narrow: "
                       "ci=0.002 (half width) or rel=0.1 (half width over rate); "
                       "the intervals are valid although the run stops by what it sees")
          ->check([](const std::string& text) {
            PrecisionTarget::Parse(text);  // throws
            return std::string();
          })
          ->excludes(trials)
          ->excludes(repeats);
  command
      ->add_option("--until-event", arguments->until_event,
                   "event of --until: failure, refusal or failure_or_refusal")
      ->check(MakeChoiceValidator(TrialEventNames()))
      ->capture_default_str()
      ->needs(until);
  command
      ->add_option("--max-trials", arguments->max_trials,
                   "greatest number of trials per condition of --until")
      ->transform(WholeNumberIn(100, 2'000'000'000))
      ->capture_default_str()
      ->needs(until);
  CLI::Option* shard = command->add_option(
      "--shard", arguments->shard,
      "I/N: run the I-th of N shares of every condition's trials into a file for `rcme merge`; "
      "auto/N or auto: the share of this task of a Slurm array or Kubernetes indexed job "
      "(docs/many_machines.md)");
  command
      ->add_option("--merged", arguments->merged,
                   "merged result file of the earlier rounds, for the next round of --until in shards")
      ->needs(until)
      ->needs(shard);
  command
      ->add_option(
          "--keep", arguments->keep,
          "all: every trial; counts: the exact sums that `rcme summarize` needs and a few complete trials, "
          "in a file that does not grow with the number of trials")
      ->check(MakeChoiceValidator({"all", "counts"}))
      ->capture_default_str()
      ->excludes(until)
      ->excludes(repeats);
  command
      ->add_option(
          "--retry", arguments->retry,
          "run trials with these statuses again and replace them: no_answer,timed_out,unreadable_answer; "
          "the file records how many")
      ->delimiter(',')
      ->check(MakeChoiceValidator(NamesOfMissingAnswers()))
      ->excludes(until);
  AddTimeLimit(command, "trials", &arguments->max_time);
  AddThreadsOption(command, &arguments->threads);
  command->callback([arguments] { Run(*arguments); });
}

}  // namespace rcme
