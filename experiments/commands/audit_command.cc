
#include <memory>
#include <utility>

#include "estimator/estimator_registry.h"
#include "experiments/audit/claims/audit_output.h"
#include "experiments/audit/claims/audit_page.h"
#include "experiments/audit/claims/audit_work.h"
#include "experiments/audit/claims/case.h"
#include "experiments/audit/claims/claim_table.h"
#include "experiments/audit/claims/study_claims.h"
#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/draw_figures.h"
#include "experiments/commands/plan_of_cases.h"
#include "experiments/commands/shard_options.h"
#include "experiments/commands/study_source.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/text/message.h"
#include "experiments/core/work/stop_request.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

struct AuditArguments {
  std::string study;  // empty: the built-in scenes
  StudyChanges changes;
  std::vector<std::string> only;
  std::string budget = "quick", out, round, format = "table";
  ShardArguments shards;
  bool only_plan = false;
  int threads = 0;
};

// The claims to audit. Sets the fields of `options` that depend on their study.
std::vector<Claim> ListAuditedClaims(const AuditArguments& arguments, AuditOptions* options) {
  if (arguments.study.empty()) {
    options->seed = SeedWithoutStudy(arguments.changes);
    options->conditions = ResolveCaseSettings({});
    return AllClaims(EstimatorRegistry());
  }
  const StudyPlan plan = LoadPlanOfCases(arguments.study, arguments.changes, PlanEstimators::kMade);
  const bool is_run = !arguments.only_plan && arguments.shards.parts.empty();
  if (is_run) CheckProcessEstimators(plan.study.estimators);
  options->seed = plan.study.seed;
  options->study = plan.study.name;
  options->study_identity = plan.identity;
  options->conditions = plan.study.data;
  return StudyClaims(plan);
}

// Merges the parts of all shards. If a round is missing, writes its plan to the file of --round.
Audit MergeAudit(const std::vector<Claim>& all, const AuditOptions& options,
                 const AuditArguments& arguments) {
  MergedAudit merged = MergeAuditParts(all, options, arguments.shards.parts);
  const WorkPlan items = PlanAuditBlocks(merged.audit);
  if (merged.missing.num_items > 0 && !arguments.round.empty()) {
    WriteRound(merged.audit, merged.round, arguments.round);
    PrintMessage("{}: the next round\n", arguments.round);
  }
  RequireNoneMissing(items, merged.missing, merged.parts.num_shards);
  PrintMessage("{}\n", DescribeCosts(items, merged.parts));
  PrintMessage("{:.4g} s of it for trials beyond those that a check needed\n", merged.unneeded_seconds);
  return std::move(merged.audit);
}

// The runner has one thread, as each check has threads of its own.
constexpr int kChecksAtATime = 1;

void RunAuditPart(const Audit& plan, const AuditArguments& arguments) {
  Runner runner =
      Runner::OfShard(PlanAuditBlocks(plan), arguments.shards.ThisShard(), arguments.out, kChecksAtATime);
  GetAuditRound(plan, arguments.round.empty() ? FirstRound(plan) : ReadRound(plan, arguments.round), &runner);
  PrintPartIsDone(runner.shard(), arguments.out);
}

void WriteAudit(const Audit& audit, const std::string& out, const std::string& format) {
  const CommandResult result = MakeAuditResult(audit);
  PrintResult(result, format);
  WriteFileWhole(out + "/audit.json", result.json);
  WriteFileWhole(out + "/audit.md", AuditAsMarkdown(audit));
  DrawFigures("audit", {out, "--page"});
  PrintMessage("done: {0}/audit.html, {0}/audit.md, {0}/audit.json, {0}/audit_FAMILY.png and .pdf\n", out);
}

void RunAuditCommand(const AuditArguments& arguments) {
  const StopOnSignals stop;
  StartTimeLimit(arguments.shards.max_time);
  AuditOptions options;
  options.only = arguments.only;
  options.budget = arguments.budget == "full" ? Budget::kFull : Budget::kQuick;
  options.num_threads = arguments.threads;
  const std::vector<Claim> all = ListAuditedClaims(arguments, &options);
  if (arguments.only_plan) {
    return PrintResult(MakePlanResult(PlanAudit(all, options)), arguments.format);
  }
  if (arguments.out.empty())
    throw InputError("--out is missing; give the folder for the results, or ask for --plan");
  if (!arguments.round.empty() && arguments.shards.shard.empty() && arguments.shards.parts.empty())
    throw InputError("--round needs --shard or --merge");
  SelectClaims(all, options.only);
  if (!arguments.shards.shard.empty()) return RunAuditPart(PlanAudit(all, options), arguments);
  if (!arguments.shards.parts.empty()) {
    const Audit audit = MergeAudit(all, options, arguments);
    MakeResultFolder(arguments.out);
    return WriteAudit(audit, arguments.out, arguments.format);
  }
  MakeResultFolder(arguments.out);
  Runner runner = Runner::WithCheckpoint(PlanAuditChecks(PlanAudit(all, options)),
                                         FindCheckpointInFolder(arguments.out), kChecksAtATime);
  WriteAudit(RunAudit(all, options, &runner), arguments.out, arguments.format);
  runner.RemoveCheckpoint();
}

}  // namespace

void AddAuditCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand("audit", "Check every claim of the paper, with a verdict for each");
  command->footer(R"(Every claim is a rate or a mean with a range that counts as nominal. Its trials stop as
soon as the verdict is decided, and its intervals are valid at every look.
Writes DIR/audit.html and DIR/audit.md (to read), DIR/audit.json (everything) and a
figure per family of claims.

Examples:
  rcme audit --out audit                               all claims, a few minutes
  rcme audit --only inlier,sigma_p.theta --out audit   a family and one claim
  rcme audit --budget full --seed 2 --out audit        narrower intervals, other streams
  rcme audit --plan                                    margins, trials and power; no run

With a study of your own (cameras, noise, outliers, estimators) the command checks the
claims about calibration in each of its conditions. A claim holds if it holds in all of
them. Minimal samples and maximum likelihood use the true matches, which a simulation
knows; real pairs cannot be audited.

  rcme audit study.yaml --out audit                          all conditions
  rcme audit study.yaml --set outlier_ratio=0.3 --out audit  one level of a factor
  rcme audit study.yaml --only estimator --out audit         only the estimators' answers

If the command is stopped (Ctrl-C, SIGTERM, --max-time) or killed, run it again: decided
checks are kept in DIR/unfinished.part until the end.

On many machines, each runs a share of the trials of every check; the merged parts have
the bytes of a single run. Repeat steps 1 and 2 until step 2 no longer ends with exit
code 75 (docs/many_machines.md):

  1  rcme audit --shard 3/64 --out parts/3.json      later rounds: --round round.json
  2  rcme audit --merge parts/*.json --out audit --round round.json)");
  auto arguments = std::make_shared<AuditArguments>();
  command->add_option(
      "study", arguments->study,
      "study file (YAML) or its name: checks the claims about calibration in each of its conditions; "
      "default: every claim of the paper, on built-in scenes");
  command
      ->add_option("--only", arguments->only,
                   "ids of claims or families, separated by commas (`rcme list claims`)")
      ->delimiter(',');
  command
      ->add_option(
          "--budget", arguments->budget,
          "quick: minutes for the claims of the paper; full: hours. With a study the time grows with its "
          "conditions times its estimators, also to hours; the greatest is printed first. --max-time, "
          "--only and --set FACTOR=LEVEL bound it")
      ->check(MakeChoiceValidator({"quick", "full"}))
      ->capture_default_str();
  command->add_option("-o,--out", arguments->out,
                      "folder for the results, created if missing; with --shard the file of the part");
  CLI::Option* plan = command->add_flag(
      "--plan", arguments->only_plan,
      "only print the plan: margins, trials, and the departures found with probability 0.9");
  AddFormatOption(command, &arguments->format);
  const ShardOptions shards = AddShardOptions(command, "trials", &arguments->shards);
  command->add_option("--round", arguments->round,
                      "with --merge: file to write if trials are missing; "
                      "with --shard: that file, which names the trials to run; default: the first round");
  shards.shard->excludes(plan);
  shards.merge->excludes(plan);
  AddStudyOptions(command, &arguments->changes);
  AddProcessOption(command, &arguments->changes.allow_process);
  AddThreadsOption(command, &arguments->threads, "Results do not depend on it, except for measured times");
  command->callback([arguments] { RunAuditCommand(*arguments); });
}

}  // namespace rcme
