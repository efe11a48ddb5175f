#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/estimator_source.h"
#include "experiments/commands/study_source.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/text/message.h"
#include "experiments/core/work/stop_request.h"
#include "experiments/data/make_data.h"
#include "experiments/gate/gate_output.h"
#include "experiments/gate/gate_terms.h"
#include "experiments/run/run_study.h"
#include "experiments/study/estimator_spec.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

constexpr int kIsWorse = 1, kIsUndecided = 3;  // exit codes

struct GateArguments {
  std::string first, second, old_name, new_name, out, max_time = "5m", format = "table";
  std::vector<std::string> of = GateQuantityNames(), margins;
  bool is_of_given = false;
  double failure_at_most = -1.0, refusal_at_most = -1.0;
  std::int64_t max_trials = 1'000'000;  // per condition
  int threads = 0;
  StudyChanges changes;
};

std::vector<GateTest> TestsFrom(const GateArguments& arguments, bool has_old, bool is_same_run) {
  std::vector<GateTest> tests;
  if (has_old) {
    std::vector<std::string> names = arguments.of;
    if (!arguments.is_of_given && !is_same_run) std::erase(names, "time");
    tests = MakeGateTests(names, arguments.margins);
  } else if (arguments.is_of_given || !arguments.margins.empty()) {
    throw InputError("gate: --of and --margin compare with an old version; give --old");
  }
  for (const auto& [name, limit] :
       {std::pair("failure", arguments.failure_at_most), std::pair("refusal", arguments.refusal_at_most)}) {
    if (limit < 0.0) continue;
    tests.push_back(MakeGateTests({name}, {}).front());
    tests.back().margin = limit;
    tests.back().is_limit = true;
  }
  if (tests.empty()) throw InputError("gate: there is nothing to test; give --old or --failure-at-most");
  return tests;
}

// Refuses studies of match files: their trials repeat the same pairs.
void RequireSimulated(const Study& study) {
  for (const std::vector<std::string>& levels : DesignRows(study)) {
    for (const auto& [key, value] : CombineSettings(study, levels)) {
      if (key == "scene" && value == kMatchFilesScene)
        throw InputError(
            "gate: pairs of match files are not drawn anew by each trial; give a study of scenes");
    }
  }
}

size_t FindInFile(const RunDescription& run, const std::string& label, const std::string& option,
                  const std::string& path) {
  if (!label.empty()) return FindEstimator(run.estimators, label, fmt::format("{}: {}", option, path));
  if (run.estimators.size() == 1) return 0;
  throw InputError(fmt::format("{}: holds several estimators; choose one with {}: {}", path, option,
                               fmt::join(ListLabels(run.estimators), ", ")));
}

GateReport BeginReport(const ReadableRun& run, const std::vector<GateTest>& tests, bool has_old) {
  const RunDescription& description = run.description;
  GateReport report;
  report.study = description.study;
  if (has_old) report.old_label = description.estimators.front().label;
  report.new_label = description.estimators.back().label;
  report.num_conditions = std::ssize(description.conditions);
  report.assumptions = ListAssumptions(run, tests);
  return report;
}

// Puts a description of both versions first among the assumptions, and warns if different versions have the
// same label.
void DescribeVersions(const RecordedVersion& of_old, const RecordedVersion& of_new, GateReport* report) {
  const std::string words = CompareVersions(of_old, of_new);
  report->assumptions.insert(report->assumptions.begin(), "Versions: " + words + ".");
  if (HasMisleadingLabel(of_old, of_new))
    PrintMessage("warning: both versions are called {}, but they are not the same: {}\n",
                 of_old.estimator.label, words);
}

// Binds a result file to the terms of the test, which must stay the same from the first look to the last.
void TakeTerms(const GateTerms& terms, const std::string& path, ResultStore* store) {
  if (store->NumTrials() > 0) RequireSameTerms(terms, store->Description().stopping_rule, path);
  store->NoteStoppingRule(terms.AsStoppingRule());
}

// Runs the plan's trials until the verdict is decided.
void RunUntilDecided(StudyPlan plan, const GateArguments& arguments, std::int64_t max_rounds,
                     const ReadableRun& run, const std::vector<GateTest>& tests, ResultStore* store,
                     GateReport* report) {
  report->look = LookUntilDecided(run, tests, max_rounds, [&](std::int64_t num_rounds) {
    for (Condition& condition : plan.conditions) condition.num_trials = static_cast<int>(num_rounds);
    try {
      RunStudy(plan, arguments.threads, store);
    } catch (const Stopped&) {
      if (StopExitCode() != kTryAgain) throw;
      report->is_out_of_time = true;
    }
    return !report->is_out_of_time;
  });
}

std::string TrialsPath(const GateArguments& arguments) {
  if (arguments.out.empty())
    throw InputError("gate: --out is missing; give the folder for the trials and the report");
  MakeResultFolder(arguments.out);
  return arguments.out + "/trials.sqlite";
}

// Judges both versions, or only the new one, on the trials of a study.
GateReport GateStudy(const GateArguments& arguments) {
  Study study = LoadChangedStudy(arguments.first, arguments.changes);
  RequireFixedOptions(study, "a gate");
  RequireSimulated(study);
  if (arguments.new_name.empty()) throw InputError("gate: --new is missing; give the estimator to be judged");
  const bool has_old = !arguments.old_name.empty(), allow = arguments.changes.allow_process;
  std::vector<EstimatorSpec> versions;
  if (has_old) versions.push_back(FindStudyEstimator(study, arguments.old_name, allow));
  versions.push_back(FindStudyEstimator(study, arguments.new_name, allow));
  if (has_old) TellApart(&versions.front().label, &versions.back().label);
  study.estimators = versions;
  const std::vector<GateTest> tests = TestsFrom(arguments, has_old, /*is_same_run=*/true);
  const std::string path = TrialsPath(arguments);
  const StudyPlan plan = MakePlan(study, arguments.first);
  ResultStore store = ResultStore::OpenForRun(path, plan);
  TakeTerms(MakeGateTerms(tests, has_old ? versions.front().label : "", versions), path, &store);
  const ReadableRun run = ReadRun(store);
  GateReport report = BeginReport(run, tests, has_old);
  RunUntilDecided(plan, arguments, arguments.max_trials, run, tests, &store, &report);
  report.show_new = path;
  if (has_old) report.changed = FindChangedTrials(run, report.look.num_rounds);
  return report;
}

// Runs the new version on the problems of a result file and compares it with the old version's trials there.
GateReport GateAgainstBaseline(const GateArguments& arguments) {
  const ResultStore baseline = ResultStore::OpenForReading(arguments.first);
  const size_t e = FindInFile(baseline.Description(), arguments.old_name, "--old", arguments.first);
  Study study = baseline.StoredStudy();
  RequireFixedOptions(study, "a gate");
  RequireSimulated(study);
  std::vector<EstimatorSpec> version = {
      arguments.new_name.empty()
          ? study.estimators.at(e)
          : FindStudyEstimator(study, arguments.new_name, arguments.changes.allow_process)};
  if (arguments.changes.allow_process) AllowAndSay(&version);
  study.estimators = version;
  const std::vector<GateTest> tests = TestsFrom(arguments, true, /*is_same_run=*/false);
  const std::string path = TrialsPath(arguments);
  const StudyPlan plan = MakePlan(study, arguments.first);
  ResultStore store = ResultStore::OpenForRun(path, plan);
  const RecordedVersion recorded = FindRecordedVersion(baseline.Description(), e);
  TakeTerms(MakeGateTerms(tests, recorded.estimator.label, version, IdentifyVersion(recorded)), path, &store);
  store.NoteOrigin(ThisProgram());
  const ReadableRun run = JoinRuns(baseline, {e}, store, {0});
  GateReport report = BeginReport(run, tests, true);
  DescribeVersions(recorded, FindRecordedVersion(store.Description(), 0), &report);
  const std::int64_t max_rounds = std::min(arguments.max_trials, CountRounds(ReadRun(baseline)));
  RunUntilDecided(plan, arguments, max_rounds, run, tests, &store, &report);
  report.show_new = path;
  report.show_old = arguments.first;
  report.changed = FindChangedTrials(run, report.look.num_rounds);
  return report;
}

GateReport GateFiles(const GateArguments& arguments) {
  const ResultStore of_old = ResultStore::OpenForReading(arguments.first),
                    of_new = ResultStore::OpenForReading(arguments.second);
  const size_t old_e = FindInFile(of_old.Description(), arguments.old_name, "--old", arguments.first),
               new_e = FindInFile(of_new.Description(), arguments.new_name, "--new", arguments.second);
  RequireSimulated(of_new.StoredStudy());
  const std::vector<GateTest> tests = TestsFrom(arguments, true, /*is_same_run=*/false);
  const ReadableRun run = JoinRuns(of_old, {old_e}, of_new, {new_e});
  GateReport report = BeginReport(run, tests, true);
  DescribeVersions(FindRecordedVersion(of_old.Description(), old_e),
                   FindRecordedVersion(of_new.Description(), new_e), &report);
  const std::int64_t max_rounds = std::min(arguments.max_trials, CountRounds(run));
  if (max_rounds == 0) throw InputError("gate: a condition has no trial that both result files hold");
  report.look = LookUntilDecided(run, tests, max_rounds, [](std::int64_t) { return true; });
  report.show_new = arguments.second;
  report.show_old = arguments.first;
  report.changed = FindChangedTrials(run, report.look.num_rounds);
  return report;
}

void WriteGateReport(const GateReport& report, const std::string& out) {
  MakeResultFolder(out);
  WriteFileWhole(out + "/gate.md", GateAsMarkdown(report));
  WriteFileWhole(out + "/gate.xml", GateAsJUnit(report));
  WriteFileWhole(out + "/gate.json", GateAsJson(report));
}

void RunGate(const GateArguments& arguments) {
  const StopOnSignals stop;
  StartTimeLimit(arguments.max_time);
  const bool has_file = IsResultFile(arguments.first);
  if ((has_file || !arguments.second.empty()) && arguments.changes.AreAny())
    throw InputError(
        "gate: a result file has its own study; use --set, --add-estimator and --seed with a study");
  const GateReport report = !arguments.second.empty() ? GateFiles(arguments)
                            : has_file                ? GateAgainstBaseline(arguments)
                                                      : GateStudy(arguments);
  if (!arguments.out.empty()) WriteGateReport(report, arguments.out);
  PrintResult(MakeGateResult(report), arguments.format);
  if (report.is_out_of_time) PrintMessage("the same command goes on for another {}\n", arguments.max_time);
  if (report.look.verdict == GateVerdict::kWorse) throw EndWith{kIsWorse};
  if (report.look.verdict == GateVerdict::kUndecided) throw EndWith{kIsUndecided};
}

std::string DescribeGateQuantities() {
  std::string text;
  for (const GateQuantity& quantity : GateQuantities())
    text += fmt::format("  {:<12} {:<6} {}\n", quantity.name,
                        fmt::format("{:.3g} %", 100.0 * quantity.usual_margin), quantity.doc);
  return text;
}

}  // namespace

void AddGateCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("gate", "Decide whether a new version of an estimator is worse than an old one");
  command->footer(
      R"(Runs two versions of an estimator on the same problems until it is decided whether the new
one is worse by more than a margin. The tests are valid at every look, so that the run ends
as soon as the verdict is clear. Of each quantity the less is the better; the margins:

)" + DescribeGateQuantities() +
      R"(
Exit code: 0 not worse, 1 worse, 3 undecided within the budget, 2 wrong input. With no change
beyond its margin the exit code is 1 with probability at most 5 %, for all quantities
together; with one beyond it is 0 with probability at most 5 %.

The versions are labels of the study, names of estimators or estimator files; a version in
another program is an estimator file of `process`. A result file in place of the study is a
baseline: the new version answers its problems, and the default of --new is the estimator
of the file itself, as this program has it. Two result files are compared without a run.
Times of two runs are judged only if --of names them.

Writes DIR/gate.md (for a pull request), DIR/gate.xml (JUnit), DIR/gate.json and
DIR/trials.sqlite. If the command is stopped or the time is over, run it again: it goes on.
Other margins, other quantities, another baseline, or another build of rcme or of a
version's program need another DIR. Of baselines the report says which estimator, options
and program the labels stand for, and a warning if one label stands for two.

Examples:
  rcme gate study.yaml --old rcme --new rcme_calibrated --out gate
  rcme gate study.yaml --old before.yaml --new after.yaml --margin failure=0.01 --out gate
  rcme gate study.yaml --new rcme_calibrated --failure-at-most 0.02 --out gate
  rcme gate baseline.sqlite --out gate
  rcme gate before.sqlite after.sqlite)");
  auto arguments = std::make_shared<GateArguments>();
  command
      ->add_option("study", arguments->first,
                   "study file (YAML) or its name, or result file of the old version")
      ->required();
  command->add_option("run", arguments->second, "result file of the new version, of the same study");
  command->add_option("--old", arguments->old_name, "the old version: label, estimator or estimator file");
  command->add_option("--new", arguments->new_name, "the new version, likewise");
  CLI::Option* of = command->add_option("--of", arguments->of, "quantities a,b,... that are judged")
                        ->delimiter(',')
                        ->allow_extra_args(false)
                        ->check(MakeChoiceValidator(GateQuantityNames()));
  command
      ->add_option("--margin", arguments->margins,
                   "quantity=margin, repeatable: as a rate, of error and time as a share")
      ->allow_extra_args(false);
  command
      ->add_option("--failure-at-most", arguments->failure_at_most,
                   "also judge the failure rate of the new version by this limit; --old is not needed then")
      ->transform(NumberIn({1e-6, 1.0 - 1e-6}));
  command->add_option("--refusal-at-most", arguments->refusal_at_most, "the same of its refusals")
      ->transform(NumberIn({1e-6, 1.0 - 1e-6}));
  command->add_option("-o,--out", arguments->out, "folder for the report and the trials; it is made");
  AddFormatOption(command, &arguments->format);
  AddTimeLimit(command, "trials", &arguments->max_time)
      ->description("undecided after this time (55m, 1h30m, 90s)")
      ->capture_default_str();
  command->add_option("--max-trials", arguments->max_trials, "undecided after so many trials per condition")
      ->transform(WholeNumberIn(1, 2'000'000'000))
      ->capture_default_str();
  AddStudyOptions(command, &arguments->changes);
  AddProcessOption(command, &arguments->changes.allow_process);
  AddThreadsOption(command, &arguments->threads,
                   "Only times, and how far the time limit lets it come, depend on it");
  command->callback([arguments, of] {
    arguments->is_of_given = of->count() > 0;
    RunGate(*arguments);
  });
}

}  // namespace rcme
