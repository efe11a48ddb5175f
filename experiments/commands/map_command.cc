
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "experiments/audit/validity/map_work.h"
#include "experiments/audit/validity/study_samples.h"
#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/plan_of_cases.h"
#include "experiments/commands/shard_options.h"
#include "experiments/commands/study_source.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/table/render_table.h"
#include "experiments/core/text/json_output.h"
#include "experiments/core/text/message.h"
#include "experiments/core/work/for_each_index.h"
#include "experiments/core/work/progress.h"
#include "experiments/core/work/stop_request.h"

namespace rcme {
namespace {

constexpr int kDrawsPerSample = 100;

struct MapArguments {
  std::string study;  // empty: the built-in scene
  StudyChanges changes;
  std::string out, format = "table";
  ShardArguments shards;
  int trials = ValidityMapOptions{}.trials;
  int threads = 0;
};

// The study's conditions and noise levels, and its seed.
MapWork WorkOnStudy(const MapArguments& arguments) {
  const StudyPlan plan = LoadPlanOfCases(arguments.study, arguments.changes, PlanEstimators::kNotMade);
  MapWork work{{}, std::nullopt, plan.identity};
  ValidityMapOptions& map = work.map;
  map.seed = plan.study.seed;
  map.condition_key = "condition";
  map.conditions = ListMapConditions(plan);
  for (const double sigma_px : ListSigmas(plan)) map.sigmas_px.push_back(sigma_px);
  std::ranges::sort(map.sigmas_px);
  map.sigmas_px.erase(std::unique(map.sigmas_px.begin(), map.sigmas_px.end()), map.sigmas_px.end());
  return work;
}

MapWork WorkOnBuiltInScene(const MapArguments& arguments) {
  MapWork work;
  work.map.seed = SeedWithoutStudy(arguments.changes);
  ValidityReferenceOptions& reference = work.reference.emplace();
  reference.num_draws = kDrawsPerSample;
  reference.num_samples = std::max(1, arguments.trials / kDrawsPerSample);
  reference.seed = work.map.seed;
  return work;
}

// The tables of a run, the first of which is the map.
std::vector<NamedTable> MakeMapTables(const MapWork& work, const Runner& runner) {
  std::vector<NamedTable> tables = {
      {"map", MakeValidityMapTable(work.map, TrialsIn(work, runner.plan(), runner.results()))}};
  if (work.reference) {
    tables.push_back({"reference", MakeValidityReferenceTable(
                                       *work.reference, CountsIn(work, runner.plan(), runner.results()))});
  }
  return tables;
}

// Writes one file for each table; the result for people lists their names.
CommandResult WriteMap(const MapArguments& arguments, const std::vector<NamedTable>& tables) {
  std::string paths;
  for (const NamedTable& each : tables) {
    const std::string path =
        (std::filesystem::path(arguments.out) / ("validity_" + each.name + ".csv")).string();
    WriteFileWhole(path, RenderCsv(each.table));
    paths += path + "\n";
  }
  return MakeResult(paths, kMapFormat, {{"trials", std::int64_t{arguments.trials}}}, tables.front().table,
                    {tables.begin() + 1, tables.end()});
}

void Map(const MapArguments& arguments) {
  const StopOnSignals stop;
  StartTimeLimit(arguments.shards.max_time);
  MapWork work = arguments.study.empty() ? WorkOnBuiltInScene(arguments) : WorkOnStudy(arguments);
  work.map.trials = arguments.trials;
  const bool is_part = !arguments.shards.shard.empty(), is_merge = !arguments.shards.parts.empty();
  // Now, as the first table is written minutes later.
  if (!is_part && !is_merge) MakeResultFolder(arguments.out);
  Runner runner = MakeRunner(PlanMapWork(work), arguments.shards, arguments.out,
                             FindCheckpointInFolder(arguments.out), arguments.threads);
  if (!is_part && !is_merge) {
    PrintMessage("map: {} conditions, {} cells; about {} on {} threads\n", work.map.conditions.size(),
                 NumCells(work.map),
                 DescribeDuration(SecondsOfWork(work.map) / NumThreads(arguments.threads)),
                 NumThreads(arguments.threads));
  }
  GetMapResults(work, &runner);
  if (is_part) return PrintPartIsDone(runner.shard(), arguments.out);
  PrintCosts(runner);
  MakeResultFolder(arguments.out);
  PrintResult(WriteMap(arguments, MakeMapTables(work, runner)), arguments.format);
  runner.RemoveCheckpoint();
}

}  // namespace

void AddMapCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "map", "Map where first-order covariances hold: coverage over noise, points and parallax");
  command->footer(R"(Draws correct samples of 8 to 100 matches, estimates f and the motion linearly,
propagates the noise to first order, and counts how often the truth lies in the 95 %
region. A coverage below 0.95 means that the covariance is too small. A sample without a
model counts as not covered. The defaults take six minutes on one core.
Writes two tables with n and exact 95 % intervals; those of the second are of its fixed
samples alone, not of all that the family has:
  validity_map.csv        120 cells (8 noise levels, 5 sample sizes, 3 baselines) for f,
                          pose, the inlier test of a fresh_point, and ml_pose (maximum
                          likelihood); over all trials, and over thirds of the sample's
                          conditioning, without noise (exact_) and as observed (observed_)
  validity_reference.csv  6 cells: the same draws with first-order, unscented and
                          Monte-Carlo covariances, to tell linearisation error from a
                          wrong formula

With a STUDY the samples are true matches of its scene, cameras and motion, with its
noise law. There is a map per condition, at the study's noise level and the map's
eight, and no reference table. A cell has n = 0 if no trial has enough true matches or
a direction of translation.

If the command is stopped or killed, run it again: finished work is kept in
OUT/unfinished.part until the end.

Examples:
  rcme map --out map
  rcme map study.yaml --set outlier_ratio=0 --out map
  rcme plot validity_map map
  rcme map --shard 3/64 --out parts/3.json   the share of one of 64 machines
                                             (docs/many_machines.md)
  rcme map --merge parts/*.json --out map    all shares: the bytes of a single run)");
  auto arguments = std::make_shared<MapArguments>();
  command->add_option("study", arguments->study,
                      "study file (YAML) or its name; default: the built-in scene");
  command
      ->add_option("-o,--out", arguments->out,
                   "folder for the tables, created if missing; with --shard the file of the part")
      ->required();
  AddFormatOption(command, &arguments->format);
  AddShardOptions(command, "trials", &arguments->shards);
  command
      ->add_option(
          "--trials", arguments->trials,
          "trials per cell of the map; the reference takes a hundredth as many samples of 100 draws each")
      ->transform(WholeNumberIn(1, 100'000'000))
      ->capture_default_str();
  AddStudyOptions(command, &arguments->changes);
  AddThreadsOption(command, &arguments->threads);
  command->callback([arguments] { Map(*arguments); });
}

}  // namespace rcme
