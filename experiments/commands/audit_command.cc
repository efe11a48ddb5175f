#include <fmt/format.h>

#include <memory>
#include <utility>

#include "estimator/estimator_registry.h"
#include "experiments/audit/claims/audit_output.h"
#include "experiments/audit/claims/audit_work.h"
#include "experiments/audit/claims/case.h"
#include "experiments/audit/claims/claim_table.h"
#include "experiments/audit/claims/study_claims.h"
#include "experiments/commands/commands.h"
#include "experiments/commands/draw_figures.h"
#include "experiments/commands/number_option.h"
#include "experiments/commands/process_option.h"
#include "experiments/commands/shard_options.h"
#include "experiments/commands/study_source.h"
#include "experiments/commands/time_limit.h"
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
  std::string budget = "quick", out, round;
  ShardArguments shards;
  bool only_plan = false;
  int threads = 0;
};

// The claims to audit, and what the options have to say of where they are made.
std::vector<Claim> ClaimsOf(const AuditArguments& arguments, AuditOptions* options) {
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

// Of all shards. Where a round is missing, writes which.
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
  PrintMessage("{:.4g} s of it for trials after those that a check took\n", merged.unneeded_seconds);
  return std::move(merged.audit);
}

// A check has threads of its own, so that the runner has one.
constexpr int kChecksAtATime = 1;

void RunAuditPart(const Audit& plan, const AuditArguments& arguments) {
  Runner runner =
      Runner::OfShard(PlanAuditBlocks(plan), arguments.shards.ThisShard(), arguments.out, kChecksAtATime);
  GetAuditRound(plan, arguments.round.empty() ? FirstRound(plan) : ReadRound(plan, arguments.round), &runner);
  PrintPartIsDone(runner.shard(), arguments.out);
}

void WriteAudit(const Audit& audit, const std::string& out) {
  fmt::print("{}", AuditAsTable(audit));
  WriteFileWhole(out + "/audit.json", AuditAsJson(audit));
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
  const std::vector<Claim> all = ClaimsOf(arguments, &options);
  if (arguments.only_plan) {
    fmt::print("{}", PlanAsTable(PlanAudit(all, options)));
    return;
  }
  if (arguments.out.empty())
    throw InputError("--out is missing: the folder for the results (or ask for --plan)");
  if (!arguments.round.empty() && arguments.shards.shard.empty() && arguments.shards.parts.empty())
    throw InputError("--round: only with --shard or --merge");
  SelectClaims(all, options.only);
  if (!arguments.shards.shard.empty()) return RunAuditPart(PlanAudit(all, options), arguments);
  if (!arguments.shards.parts.empty()) {
    const Audit audit = MergeAudit(all, options, arguments);
    MakeResultFolder(arguments.out);
    return WriteAudit(audit, arguments.out);
  }
  MakeResultFolder(arguments.out);
  Runner runner = Runner::WithCheckpoint(PlanAuditChecks(PlanAudit(all, options)),
                                         FindCheckpointInFolder(arguments.out), kChecksAtATime);
  WriteAudit(RunAudit(all, options, &runner), arguments.out);
  runner.RemoveCheckpoint();
}

}  // namespace

void AddAuditCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "audit",
      "Check every claim of the paper: it holds, holds at small noise only, does not hold, or is undecided");
  command->footer(
      "Every claim is a rate or a mean with the range that counts as nominal. Its trials stop when the "
      "verdict is\n"
      "decided; the intervals hold however often they are looked at. Writes DIR/audit.html and "
      "DIR/audit.md\n"
      "(to read), DIR/audit.json (everything) and one figure per family of claims.\n"
      "\n"
      "  rcme audit --out audit                                   all claims, at most a few minutes\n"
      "  rcme audit --only inlier,sigma_p.theta --out audit       a family and one claim\n"
      "  rcme audit --budget full --seed 2 --out audit            narrow intervals, other random streams\n"
      "  rcme audit --plan                                        margins, trials and power, without a run\n"
      "\n"
      "On a study of your own (your cameras, your noise, your outliers, your estimators) it checks the "
      "claims "
      "about\n"
      "calibration in each condition; a claim holds if it holds in all of them. Minimal samples and maximum\n"
      "likelihood are of true matches, which a simulation knows; real pairs cannot be audited.\n"
      "\n"
      "  rcme audit study.yaml --out audit                        all conditions; says the time beforehand\n"
      "  rcme audit study.yaml --set outlier_ratio=0.3 --out audit    one level of a factor\n"
      "  rcme audit study.yaml --only estimator --out audit       only what the study's estimators report\n"
      "\n"
      "Stopped (Ctrl-C, SIGTERM, --max-time) or killed, the same command goes on: the checks that are "
      "decided\n"
      "are kept in DIR/unfinished.part until the end.\n"
      "\n"
      "On many machines each runs a share of every check's trials; the parts give the same bytes as one run. "
      "It goes\n"
      "in rounds, each of them 1 and 2, until 2 does not end with exit code 75 (docs/many_machines.md):\n"
      "\n"
      "  1  rcme audit --shard 3/64 --out parts/3.json                    later rounds: --round round.json\n"
      "  2  rcme audit --merge parts/*.json --out audit --round round.json");
  auto arguments = std::make_shared<AuditArguments>();
  command->add_option("study", arguments->study,
                      "study file (YAML): the claims about calibration on its scene, cameras, motion, noise, "
                      "outliers and estimators, in each of its conditions. Without one: every claim of the "
                      "paper, on built-in scenes");
  command
      ->add_option("--only", arguments->only,
                   "ids of claims or of families, comma-separated; `rcme list claims`")
      ->delimiter(',');
  command
      ->add_option("--budget", arguments->budget, "quick (minutes) or full (up to hours; says so beforehand)")
      ->check(OneOf({"quick", "full"}))
      ->capture_default_str();
  command->add_option("-o,--out", arguments->out,
                      "folder for the results, made if missing; with --shard the file of the part");
  CLI::Option* plan = command->add_flag(
      "--plan", arguments->only_plan,
      "only print the plan: margins, trials, and what each claim finds with probability 0.9");
  const ShardOptions shards = AddShardOptions(command, "trials", &arguments->shards);
  command->add_option(
      "--round", arguments->round,
      "with --merge: written where trials are missing; with --shard: which trials to run, those "
      "of the first round unless given");
  shards.shard->excludes(plan);
  shards.merge->excludes(plan);
  AddStudyOptions(command, &arguments->changes);
  AddProcessOption(command, &arguments->changes.allow_process);
  command
      ->add_option("--threads", arguments->threads,
                   "threads; 0: one per core. The results do not depend on it, measured times excepted")
      ->transform(WholeNumberIn(0, 1024));
  command->callback([arguments] { RunAuditCommand(*arguments); });
}

}  // namespace rcme
