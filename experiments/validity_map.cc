#include "experiments/validity_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <numeric>
#include <span>

#include "estimator/point_consistency.h"
#include "estimator/refinement/sampson_mle.h"
#include "experiments/covariance_score.h"
#include "experiments/for_each_index.h"
#include "experiments/progress.h"
#include "stats/accuracy.h"
#include "stats/distributions.h"
#include "stats/intervals.h"

namespace rcme {
namespace {

constexpr double kNominalCoverage = 0.95;

struct Quantity {
  const char* name;
  int degrees_of_freedom;
  double ValidityTrial::*statistic;
};
constexpr std::array<Quantity, 4> kQuantities = {{{"f", 8, &ValidityTrial::f_nees},
                                                  {"pose", 5, &ValidityTrial::pose_nees},
                                                  {"fresh_point", 1, &ValidityTrial::fresh_point_d2},
                                                  {"ml_pose", 5, &ValidityTrial::ml_pose_nees}}};

struct Cell {
  double baseline_m;
  int num_points;
  double sigma_px;
  std::vector<ValidityTrial> trials;
};

// Trials of a cell that are counted together.
struct Group {
  std::string name;
  double median_conditioning;
  std::vector<const ValidityTrial*> trials;
};

Group MakeGroup(std::string name, double ValidityTrial::*conditioning,
                std::vector<const ValidityTrial*> trials) {
  std::vector<double> values;
  for (const ValidityTrial* trial : trials) values.push_back(trial->*conditioning);
  return {std::move(name), MeasureQuantile(std::move(values), 0.5).value, std::move(trials)};
}

// All trials, then the thirds by either conditioning; trials without a model are in the lower third.
std::vector<Group> GroupsOf(const std::vector<ValidityTrial>& trials) {
  std::vector<const ValidityTrial*> order;
  for (const ValidityTrial& trial : trials) order.push_back(&trial);
  std::vector<Group> groups = {MakeGroup("all", &ValidityTrial::observed_conditioning, order)};
  const auto add_thirds = [&](const std::string& measure, double ValidityTrial::*conditioning) {
    std::stable_sort(order.begin(), order.end(), [&](const ValidityTrial* a, const ValidityTrial* b) {
      return a->*conditioning < b->*conditioning;
    });
    const auto n = static_cast<std::ptrdiff_t>(order.size());
    const std::array<const char*, 3> thirds = {"lower", "middle", "upper"};
    for (std::ptrdiff_t k = 0; k < 3; ++k) {
      const auto first = order.begin() + n * k / 3, end = order.begin() + n * (k + 1) / 3;
      if (first == end) continue;  // fewer than three trials
      groups.push_back(MakeGroup(measure + "_" + thirds[static_cast<size_t>(k)], conditioning, {first, end}));
    }
  };
  add_thirds("exact", &ValidityTrial::exact_conditioning);
  add_thirds("observed", &ValidityTrial::observed_conditioning);
  return groups;
}

std::int64_t CountCovered(const Group& group, const Quantity& quantity) {
  const double limit = ChiSquareQuantile(quantity.degrees_of_freedom, kNominalCoverage);
  return std::count_if(group.trials.begin(), group.trials.end(),
                       [&](const ValidityTrial* trial) { return trial->*quantity.statistic <= limit; });
}

std::string RowsOf(const Cell& cell, double median_parallax_deg) {
  std::string text;
  for (const Group& group : GroupsOf(cell.trials)) {
    for (const Quantity& quantity : kQuantities) {
      const auto n = static_cast<std::int64_t>(group.trials.size());
      const std::int64_t num_covered = CountCovered(group, quantity);
      const Interval interval = ExactBinomialInterval(num_covered, n);
      text += fmt::format("{},{},{},{:.4g},{},{:.3g},{},{},{},{:.4f},{:.4f},{:.4f}\n", cell.sigma_px,
                          cell.num_points, cell.baseline_m, median_parallax_deg, group.name,
                          group.median_conditioning, quantity.name, n, num_covered,
                          static_cast<double>(num_covered) / static_cast<double>(n), interval.lower,
                          interval.upper);
    }
  }
  return text;
}

// Over all cells of one baseline, which differ in nothing that parallax depends on.
double MedianParallaxDeg(std::span<const Cell> cells) {
  std::vector<double> parallaxes_rad;
  for (const Cell& cell : cells) {
    for (const ValidityTrial& trial : cell.trials) parallaxes_rad.push_back(trial.parallax_rad);
  }
  return MeasureQuantile(std::move(parallaxes_rad), 0.5).value * 180.0 / std::numbers::pi;
}

}  // namespace

ValidityTrial RunValidityTrial(const SampleFamily& family, const StreamName& name) {
  const Scene scene = family.MakeScene(name);
  const RelativePose& pose_true = scene.cam2_from_cam1_true;
  RandomStream noise_rng = StreamFor(name, StreamPurpose::kNoise);
  const ObservedSample sample = family.Observe(scene, name, noise_rng);

  ValidityTrial trial;
  trial.parallax_rad = ParallaxRad(scene, scene.points_in_cam1.back());
  if (const auto exact = EstimateLinearMotion(family.ObserveExactly(scene, name).problem)) {
    trial.exact_conditioning = exact->fit.conditioning;
  }
  const std::optional<LinearMotion> motion = EstimateLinearMotion(sample.problem);
  if (!motion) return trial;
  trial.observed_conditioning = motion->fit.conditioning;

  const RelativePose pose = NearestPose(motion->poses, pose_true);
  const Matrix5d pose_cov = CovarianceOfMotion(pose, motion->f_cov);
  trial.f_nees = NormalizedErrorOfF(*motion, pose_true);
  trial.pose_nees = NormalizedErrorOfPose(pose, pose_cov, pose_true);
  if (const auto model = UncertainFundamental::From(pose, pose_cov, scene.camera1, scene.camera2)) {
    PointResidual residual;
    trial.fresh_point_d2 =
        RankAwareTest(*model, sample.problem.sigma_px).Distance(sample.fresh_match, &residual);
  }
  const RefinedMotion refined = RefineAllBySampson(sample.problem, pose);
  if (refined.converged) {
    trial.ml_pose_nees = NormalizedErrorOfPose(refined.cam2_from_cam1, refined.pose_cov, pose_true);
  }
  return trial;
}

std::string ValidityMapCsv(const ValidityMapOptions& options) {
  const std::int64_t cells_per_baseline =
      static_cast<std::int64_t>(options.nums_points.size() * options.sigmas_px.size());
  const std::int64_t num_cells = cells_per_baseline * static_cast<std::int64_t>(options.baselines_m.size());
  Progress progress("trials of the map", num_cells * options.trials);
  std::string text =
      "sigma_px,num_points,baseline_m,median_parallax_deg,conditioning,median_conditioning,quantity,n,"
      "num_covered,coverage,lower,upper\n";
  std::uint32_t cell_index = 0;
  for (const double baseline_m : options.baselines_m) {
    std::vector<Cell> cells;
    for (const int num_points : options.nums_points) {
      for (const double sigma_px : options.sigmas_px) {
        const SampleFamily family(num_points, baseline_m, sigma_px);
        std::vector<ValidityTrial> trials(static_cast<size_t>(options.trials));
        ForEachIndex(options.trials, options.num_threads, [&](std::int64_t trial) {
          const StreamName name{options.seed, cell_index, static_cast<std::uint32_t>(trial)};
          trials[static_cast<size_t>(trial)] = RunValidityTrial(family, name);
          progress.Advance(1);
        });
        cells.push_back({baseline_m, num_points, sigma_px, std::move(trials)});
        ++cell_index;
      }
    }
    const double median_parallax_deg = MedianParallaxDeg(cells);
    for (const Cell& cell : cells) text += RowsOf(cell, median_parallax_deg);
  }
  return text;
}

}  // namespace rcme
