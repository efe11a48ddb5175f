#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "experiments/base/file_output.h"
#include "experiments/base/for_each_index.h"
#include "experiments/base/message.h"
#include "experiments/base/progress.h"
#include "experiments/base/stop_request.h"
#include "experiments/commands/commands.h"
#include "experiments/commands/number_option.h"
#include "experiments/commands/study_source.h"
#include "experiments/validity/study_samples.h"
#include "experiments/validity/validity_map.h"
#include "experiments/validity/validity_reference.h"

namespace rcme {
namespace {

constexpr int kDrawsPerSample = 100;

struct MapArguments {
  std::string study;  // empty: the built-in scene
  StudyChanges changes;
  std::string out;
  int trials = ValidityMapOptions{}.trials;
  int threads = 0;
};

// Puts the study's conditions and noise levels into the map, and the study's seed.
void UseStudy(const MapArguments& arguments, ValidityMapOptions* map) {
  const StudyPlan plan = LoadPlanOfCases(arguments.study, arguments.changes);
  map->seed = plan.study.seed;
  map->condition_key = "condition";
  map->conditions = MapConditionsOf(plan);
  for (const double sigma_px : SigmasOf(plan)) map->sigmas_px.push_back(sigma_px);
  std::ranges::sort(map->sigmas_px);
  map->sigmas_px.erase(std::unique(map->sigmas_px.begin(), map->sigmas_px.end()), map->sigmas_px.end());
}

void WriteReference(const MapArguments& arguments, const std::string& path) {
  ValidityReferenceOptions reference;
  reference.num_draws = kDrawsPerSample;
  reference.num_samples = std::max(1, arguments.trials / kDrawsPerSample);
  reference.seed = SeedWithoutStudy(arguments.changes);
  reference.num_threads = arguments.threads;
  WriteFileWhole(path, ValidityReferenceCsv(reference));
  fmt::print("{}\n", path);
}

void Map(const MapArguments& arguments) {
  const StopOnSignals stop;
  const std::filesystem::path folder(arguments.out);
  ValidityMapOptions map;
  map.trials = arguments.trials;
  map.num_threads = arguments.threads;
  if (arguments.study.empty()) {
    map.seed = SeedWithoutStudy(arguments.changes);
  } else {
    UseStudy(arguments, &map);
  }
  MakeResultFolder(arguments.out);  // minutes before the first table is written
  PrintMessage("map: {} conditions, {} cells; about {} on {} threads\n", map.conditions.size(), NumCells(map),
               DurationInWords(SecondsOfWork(map)), NumThreads(map.num_threads));
  const std::string map_path = (folder / "validity_map.csv").string();
  WriteFileWhole(map_path, ValidityMapCsv(map));
  fmt::print("{}\n", map_path);
  if (arguments.study.empty()) WriteReference(arguments, (folder / "validity_reference.csv").string());
}

}  // namespace

void AddMapCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "map", "Where are first-order covariances good enough? Coverage over noise, points and parallax");
  command->footer(
      "Draws correct samples of 8 to 100 matches, estimates f and the motion linearly, propagates the noise "
      "to\n"
      "first order and counts how often the truth lies in the 95 % region. Below 0.95 a covariance is too\n"
      "small: it promises more than it holds. Writes two tables, with n and exact 95 % intervals:\n"
      "  validity_map.csv        120 cells (8 noise levels, 5 sample sizes, 3 baselines); for f, pose, a\n"
      "                          fresh_point's inlier test, and ml_pose (maximum likelihood on the sample);\n"
      "                          over all trials and over thirds of the sample's conditioning, without "
      "noise\n"
      "                          (exact_) and as an estimator sees it (observed_)\n"
      "  validity_reference.csv  6 cells: the same draws covered by first-order, unscented and Monte-Carlo\n"
      "                          covariances, to tell linearisation error from a wrong formula\n"
      "A sample without a model counts as not covered. The defaults take six minutes of one core.\n"
      "\n"
      "With a STUDY the samples are true matches of its scene, cameras and motion under its noise law, for "
      "each "
      "of\n"
      "its conditions and at its own noise level beside the map's eight; there is no reference table then. A "
      "cell\n"
      "for which no trial has enough true matches, or a direction of translation, has n = 0.\n"
      "\n"
      "Example:\n"
      "  rcme map --out map\n"
      "  rcme map study.yaml --set outlier_ratio=0 --out map\n"
      "  rcme plot validity_map map");
  auto arguments = std::make_shared<MapArguments>();
  command->add_option("study", arguments->study, "study file (YAML); without one: the built-in scene");
  command->add_option("-o,--out", arguments->out, "folder for the tables; made if it is missing")->required();
  command
      ->add_option("--trials", arguments->trials,
                   "trials per cell of the map; the reference takes a hundredth as many samples, with 100 "
                   "draws each")
      ->transform(WholeNumberIn(1, 100'000'000))
      ->capture_default_str();
  AddStudyOptions(command, &arguments->changes);
  command
      ->add_option("--threads", arguments->threads,
                   "threads; 0: one per core. The results do not depend on it")
      ->transform(WholeNumberIn(0, 1024));
  command->callback([arguments] { Map(*arguments); });
}

}  // namespace rcme
