// The validity map: where is first-order propagation accurate enough? It shows the coverage of the 95 %
// regions of linear least-squares estimates by noise, number of points and conditioning of the sample, on the
// built-in scene at several baselines or in the conditions of a study.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "experiments/audit/validity/sample_family.h"
#include "experiments/core/table/table.h"
#include "experiments/trial/trial_range.h"

namespace rcme {

// The input of one trial: a sample with noise and without, in the same order, and the truth.
struct MapSample {
  RelativePose pose_true;
  ObservedSample observed, exact;
  double parallax_rad = 0.0;  // of one of the scene's points
};
// A pure function of the name; nullopt if the trial has no such sample.
using MapSampler = std::function<std::optional<MapSample>(const StreamName&)>;

// One row of panels of the map: the source of samples with a number of matches and a noise level.
struct MapCondition {
  std::string level;
  std::function<MapSampler(int num_points, double sigma_px)> sampler;
};
// The default uniform volume (depths of 2 to 8 m) at several baselines.
std::vector<MapCondition> AtBaselines(const std::vector<double>& baselines_m);

struct ValidityMapOptions {
  std::vector<double> sigmas_px = {0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0};
  std::vector<int> nums_points = {8, 12, 20, 50, 100};
  std::string condition_key = "baseline_m";  // column of the conditions' levels
  std::vector<MapCondition> conditions = AtBaselines({0.1, 0.5, 1.5});
  int trials = 10'000;  // per cell
  std::uint64_t seed = 1;
};

// The results of one sample. Values that could not be computed stay infinite, which no region covers, and a
// sample without a model has conditioning zero. So nothing is dropped.
struct ValidityTrial {
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  double f_nees = kNone;               // of Sigma_f = G D G', 8 dof
  double pose_nees = kNone;            // of Sigma_p = J_p Sigma_f J_p', 5 dof
  double fresh_point_d2 = kNone;       // rank-aware test of a match that took no part, 1 dof
  double ml_pose_nees = kNone;         // of the maximum-likelihood motion and its covariance, 5 dof
  double exact_conditioning = 0.0;     // smallest over largest singular value of M A without noise ...
  double observed_conditioning = 0.0;  // ... and as the estimator sees it
  double parallax_rad = 0.0;           // of one of the scene's points
};
ValidityTrial RunValidityTrial(const MapSample& sample);

// A cell is a condition with a number of points and a noise level. The conditions vary slowest, the noise
// fastest.
std::int64_t NumCells(const ValidityMapOptions& options);
std::string DescribeCell(const ValidityMapOptions& options, std::uint32_t cell);

// Runs these trials of a cell. Returns those that have a sample, in their order.
std::vector<ValidityTrial> RunTrialsOfCell(const ValidityMapOptions& options, std::uint32_t cell,
                                           TrialRange trials);

// Estimates how long the map takes on one thread, from a few trials of each condition and number of points.
double SecondsOfWork(const ValidityMapOptions& options);

// validity_map.csv: one row per cell, conditioning group and quantity, with exact 95 % intervals. The groups
// of a cell are all its trials, and their lower, middle and upper third by either conditioning. A trial
// without a sample does not count in n; a cell without samples is a row with n = 0. `trials_of` returns all
// trials of a cell that have a sample.
using TrialsOfCell = std::function<std::vector<ValidityTrial>(std::uint32_t cell)>;
Table MakeValidityMapTable(const ValidityMapOptions& options, const TrialsOfCell& trials_of);

}  // namespace rcme
