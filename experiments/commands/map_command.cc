#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "experiments/commands/commands.h"
#include "experiments/commands/number_option.h"
#include "experiments/file_output.h"
#include "experiments/validity_map.h"
#include "experiments/validity_reference.h"

namespace rcme {
namespace {

constexpr int kDrawsPerSample = 100;

struct MapArguments {
  std::string out;
  int trials = ValidityMapOptions{}.trials;
  std::int64_t seed = 1;
  int threads = 0;
};

void Map(const MapArguments& arguments) {
  MakeResultFolder(arguments.out);  // minutes before the first table is written
  const std::string map_path = (std::filesystem::path(arguments.out) / "validity_map.csv").string();
  const std::string reference_path =
      (std::filesystem::path(arguments.out) / "validity_reference.csv").string();

  ValidityMapOptions map;
  map.trials = arguments.trials;
  map.seed = static_cast<std::uint64_t>(arguments.seed);
  map.num_threads = arguments.threads;
  WriteFileWhole(map_path, ValidityMapCsv(map));

  ValidityReferenceOptions reference;
  reference.num_draws = kDrawsPerSample;
  reference.num_samples = std::max(1, arguments.trials / kDrawsPerSample);
  reference.seed = map.seed;
  reference.num_threads = map.num_threads;
  WriteFileWhole(reference_path, ValidityReferenceCsv(reference));
  fmt::print("{}\n{}\n", map_path, reference_path);
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
      "Example:\n"
      "  rcme map --out map\n"
      "  python3 plots/validity_map.py map");
  auto arguments = std::make_shared<MapArguments>();
  command->add_option("-o,--out", arguments->out, "folder for the two tables; made if it is missing")
      ->required();
  command
      ->add_option("--trials", arguments->trials,
                   "trials per cell of the map; the reference takes a hundredth as many samples, with 100 "
                   "draws each")
      ->transform(WholeNumberIn(1, 100'000'000))
      ->capture_default_str();
  command->add_option("--seed", arguments->seed, "seed of all random streams")
      ->transform(WholeNumberIn(0))
      ->capture_default_str();
  command
      ->add_option("--threads", arguments->threads,
                   "threads; 0: one per core. The results do not depend on it")
      ->transform(WholeNumberIn(0, 1024));
  command->callback([arguments] { Map(*arguments); });
}

}  // namespace rcme
