#include <fmt/format.h>

#include <memory>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/study_source.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/table/render_table.h"
#include "experiments/core/table/table.h"
#include "experiments/core/text/json_output.h"
#include "experiments/core/text/message.h"
#include "experiments/core/text/pick_name.h"
#include "experiments/core/text/shell_word.h"
#include "experiments/core/work/progress.h"
#include "experiments/core/work/stop_request.h"
#include "experiments/run/find_effort.h"
#include "experiments/study/study_file.h"

namespace rcme {
namespace {

struct BudgetArguments {
  std::string study, out, format = "table";
  StudyChanges changes;
  double time_ms = 0.0;
  std::uint32_t calls = 5;
};

std::string DescribeEffortEnd(const FoundEffort& found) {
  return PickName(found.end, {"", "has no option for its effort", "takes longer even at its least effort",
                              "stops earlier by its own rule", "reached the greatest effort allowed"});
}

// The effort found for an estimator, with its times on trials that were not used in the search.
struct BudgetRow {
  std::string estimator, effort, note;
  Estimate ms;
};

BudgetRow MakeBudgetRow(const FoundEffort& found, const std::vector<TimedProblem>& fresh) {
  const Moments ms = TimeCalls(found.spec, fresh);
  return {found.spec.label,
          DescribeEffort(found.spec),
          DescribeEffortEnd(found),
          {ms.mean(), StudentInterval(ms)}};
}

CommandResult MakeBudgetResult(const BudgetArguments& arguments, const std::string& study,
                               const std::vector<BudgetRow>& rows, size_t num_fresh) {
  using R = const BudgetRow&;
  Column ms = Column::Estimated("ms");
  ms.heading = "ms a call, fresh trials";
  Column note = Column::Text("note");
  note.heading = " ";
  const Table table = MakeTable<BudgetRow>({{Column::Key("estimator"), [](R r) { return r.estimator; }},
                                            {Column::Text("effort"), [](R r) { return r.effort; }},
                                            {ms, [](R r) { return r.ms; }},
                                            {note, [](R r) { return r.note; }}},
                                           rows);
  return MakeResult(
      fmt::format("{}\nMeans of {} calls with Student's 95 % interval over the problems; processor time of "
                  "one thread\n",
                  RenderText(table), num_fresh),
      kBudgetFormat,
      {{"study", study}, {"time_ms", arguments.time_ms}, {"calls", static_cast<std::int64_t>(num_fresh)}},
      WithIntervalColumns(table));
}

void RunBudget(const BudgetArguments& arguments) {
  const StopOnSignals stop;
  CheckIsNoInput(arguments.out, {arguments.study});
  CheckCanBeWritten(arguments.out);
  Study study = LoadChangedStudy(arguments.study, arguments.changes);
  const StudyPlan plan = MakePlan(study, arguments.study);
  CheckProcessEstimators(plan.study.estimators);
  const std::vector<TimedProblem> problems = TimedProblems(plan, 0, arguments.calls),
                                  fresh = TimedProblems(plan, arguments.calls, arguments.calls);
  std::vector<BudgetRow> rows;
  Progress progress("estimators", std::ssize(study.estimators));
  for (EstimatorSpec& spec : study.estimators) {
    if (IsStopRequested()) throw Stopped("budget: stopped, nothing written");
    const FoundEffort found = FindEffort(spec, problems, arguments.time_ms);
    spec = found.spec;
    rows.push_back(MakeBudgetRow(found, fresh));
    progress.Advance(1);
  }
  WriteFileWhole(arguments.out,
                 fmt::format("# Efforts for {:g} ms a call, found by `rcme budget {} --time-ms {:g}`.\n{}",
                             arguments.time_ms, arguments.study, arguments.time_ms, ToYaml(study)));
  PrintResult(MakeBudgetResult(arguments, study.name, rows, fresh.size()), arguments.format);
  PrintMessage("{}: the study with these efforts; next: rcme run {} --out run.sqlite\n", arguments.out,
               QuoteForShell(arguments.out));
}

}  // namespace

void AddBudgetCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("budget", "Set the effort of every estimator so that a call takes a given time");
  command->footer(R"(Many comparisons depend on how many hypotheses each estimator draws. This command finds
for each estimator the value of its effort option (num_iterations, max_iterations) at
which a call takes the given time: the mean over all conditions of the study, on this
machine, with one thread. It writes the study with these values, so everybody who runs
that file compares the same thing. If an estimator cannot reach the time, it gets the
nearest effort and the table says why. `rcme summarize` prints the effort of each.

Examples:
  rcme budget peers_uniform --time-ms 10 --out peers_10ms.yaml
  rcme run peers_10ms.yaml --out run.sqlite)");
  auto arguments = std::make_shared<BudgetArguments>();
  command
      ->add_option("STUDY", arguments->study,
                   "study file (YAML), or the name of an installed one (`rcme list studies`)")
      ->required();
  AddStudyOptions(command, &arguments->changes);
  AddProcessOption(command, &arguments->changes.allow_process);
  command->add_option("--time-ms", arguments->time_ms, "mean time of a call, ms")
      ->required()
      ->transform(NumberIn({1e-3, 1e6}));
  command
      ->add_option("--calls", arguments->calls,
                   "calls per condition and search step, and fresh calls for the table (default: 5)")
      ->transform(WholeNumberIn(1, 100'000));
  command->add_option("-o,--out", arguments->out, "study file to write, with the efforts (YAML)")->required();
  AddFormatOption(command, &arguments->format);
  command->callback([arguments] { RunBudget(*arguments); });
}

}  // namespace rcme
