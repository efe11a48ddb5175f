#include "experiments/audit/validity/validity_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <numbers>
#include <span>

#include "estimator/point_consistency.h"
#include "estimator/refinement/sampson_mle.h"
#include "experiments/audit/validity/coverage_columns.h"
#include "experiments/core/table/render_table.h"
#include "experiments/trial/covariance_score.h"
#include "stats/distributions.h"
#include "stats/measured_quantile.h"

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

struct MapCell {
  std::string level;  // of the condition
  int num_points;
  double sigma_px;
  std::vector<ValidityTrial> trials;
};

// A group of trials of a cell that are counted together.
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

// All trials, then the thirds by either conditioning. Trials without a model are in the lower third.
std::vector<Group> MakeGroups(const std::vector<ValidityTrial>& trials) {
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

// A cell without a trial has one group without a conditioning.
void AddRows(const MapCell& cell, double median_parallax_deg, Table* table) {
  const std::vector<Group> groups =
      cell.trials.empty() ? std::vector<Group>{{"all", std::nan(""), {}}} : MakeGroups(cell.trials);
  for (const Group& group : groups) {
    for (const Quantity& quantity : kQuantities) {
      const auto n = static_cast<std::int64_t>(group.trials.size());
      const std::int64_t num_covered = CountCovered(group, quantity);
      table->rows.push_back({cell.sigma_px, std::int64_t{cell.num_points}, cell.level, median_parallax_deg,
                             group.name, group.median_conditioning, quantity.name, n, num_covered});
      AddCoverage(num_covered, n, &table->rows.back());
    }
  }
}

// The median over all cells of one condition, because parallax depends on nothing else. NaN if no cell has a
// trial.
double MedianParallaxDeg(std::span<const MapCell> cells) {
  std::vector<double> parallaxes_rad;
  for (const MapCell& cell : cells) {
    for (const ValidityTrial& trial : cell.trials) parallaxes_rad.push_back(trial.parallax_rad);
  }
  if (parallaxes_rad.empty()) return std::numeric_limits<double>::quiet_NaN();
  return MeasureQuantile(std::move(parallaxes_rad), 0.5).value * 180.0 / std::numbers::pi;
}

struct CellPlace {
  size_t condition, num_points, sigma_px;  // indices into the options
};

CellPlace FindCellPlace(const ValidityMapOptions& options, std::uint32_t cell) {
  const size_t num_sigmas = options.sigmas_px.size(), num_points = options.nums_points.size();
  return {cell / (num_sigmas * num_points), cell / num_sigmas % num_points, cell % num_sigmas};
}

}  // namespace

std::vector<MapCondition> AtBaselines(const std::vector<double>& baselines_m) {
  std::vector<MapCondition> conditions;
  for (const double baseline_m : baselines_m) {
    const auto sampler = [baseline_m](int num_points, double sigma_px) -> MapSampler {
      const auto family = std::make_shared<const SampleFamily>(num_points, baseline_m, sigma_px);
      return [family](const StreamName& name) -> std::optional<MapSample> {
        const Scene scene = family->MakeScene(name);
        RandomStream noise_rng = StreamFor(name, StreamPurpose::kNoise);
        return MapSample{scene.cam2_from_cam1_true, family->Observe(scene, name, noise_rng),
                         family->ObserveExactly(scene, name),
                         ParallaxRad(scene, scene.points_in_cam1.back())};
      };
    };
    conditions.push_back({fmt::format("{}", baseline_m), sampler});
  }
  return conditions;
}

ValidityTrial RunValidityTrial(const MapSample& sample) {
  const MotionProblem& problem = sample.observed.problem;
  ValidityTrial trial;
  trial.parallax_rad = sample.parallax_rad;
  if (const auto exact = EstimateLinearMotion(sample.exact.problem)) {
    trial.exact_conditioning = exact->fit.conditioning;
  }
  const std::optional<LinearMotion> motion = EstimateLinearMotion(problem);
  if (!motion) return trial;
  trial.observed_conditioning = motion->fit.conditioning;

  const RelativePose pose = NearestPose(motion->poses, sample.pose_true);
  const Matrix5d pose_cov = CovarianceOfMotion(pose, motion->f_cov);
  trial.f_nees = NormalizedErrorOfF(*motion, sample.pose_true);
  trial.pose_nees = NormalizedErrorOfPose(pose, pose_cov, sample.pose_true);
  if (const auto model = UncertainFundamental::From(pose, pose_cov, problem.camera1, problem.camera2)) {
    PointResidual residual;
    trial.fresh_point_d2 =
        RankAwareTest(*model, problem.sigma_px).Distance(sample.observed.fresh_match, &residual);
  }
  const RefinedMotion refined = RefineAllBySampson(problem, pose);
  if (refined.converged) {
    trial.ml_pose_nees = NormalizedErrorOfPose(refined.cam2_from_cam1, refined.pose_cov, sample.pose_true);
  }
  return trial;
}

std::int64_t NumCells(const ValidityMapOptions& options) {
  return static_cast<std::int64_t>(options.conditions.size() * options.nums_points.size() *
                                   options.sigmas_px.size());
}

double SecondsOfWork(const ValidityMapOptions& options) {
  constexpr std::uint32_t kNumTimed = 4;
  const auto start = std::chrono::steady_clock::now();
  for (const MapCondition& condition : options.conditions) {
    for (const int num_points : options.nums_points) {
      const MapSampler draw = condition.sampler(num_points, options.sigmas_px.back());
      for (std::uint32_t trial = 0; trial < kNumTimed; ++trial) {
        if (const auto sample = draw({options.seed, 0, trial})) RunValidityTrial(*sample);
      }
    }
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  return elapsed.count() / kNumTimed * static_cast<double>(options.sigmas_px.size()) * options.trials;
}

std::string DescribeCell(const ValidityMapOptions& options, std::uint32_t cell) {
  const CellPlace place = FindCellPlace(options, cell);
  return fmt::format("{} {}, {} points, {} px", options.condition_key,
                     options.conditions[place.condition].level, options.nums_points[place.num_points],
                     options.sigmas_px[place.sigma_px]);
}

std::vector<ValidityTrial> RunTrialsOfCell(const ValidityMapOptions& options, std::uint32_t cell,
                                           TrialRange trials) {
  const CellPlace place = FindCellPlace(options, cell);
  const MapSampler draw = options.conditions[place.condition].sampler(options.nums_points[place.num_points],
                                                                      options.sigmas_px[place.sigma_px]);
  std::vector<ValidityTrial> with_sample;
  for (std::uint32_t trial = trials.first; trial < trials.end; ++trial) {
    if (const std::optional<MapSample> sample = draw({options.seed, cell, trial}))
      with_sample.push_back(RunValidityTrial(*sample));
  }
  return with_sample;
}

Table MakeValidityMapTable(const ValidityMapOptions& options, const TrialsOfCell& trials_of) {
  Table table{{Column::Number("sigma_px", MakeCsvFormat("")), Column::Count("num_points"),
               Column::Text(options.condition_key),
               Column::Number("median_parallax_deg", MakeCsvFormat(".4g")), Column::Text("conditioning"),
               Column::Number("median_conditioning", MakeCsvFormat(".3g")), Column::Text("quantity"),
               Column::Count("n"), Column::Count("num_covered")}};
  table.AddColumns(CoverageColumns());
  std::uint32_t cell = 0;
  for (const MapCondition& condition : options.conditions) {
    std::vector<MapCell> cells;
    for (const int num_points : options.nums_points) {
      for (const double sigma_px : options.sigmas_px)
        cells.push_back({condition.level, num_points, sigma_px, trials_of(cell++)});
    }
    const double median_parallax_deg = MedianParallaxDeg(cells);
    for (const MapCell& each : cells) AddRows(each, median_parallax_deg, &table);
  }
  return table;
}

}  // namespace rcme
