#include "experiments/audit/contract/estimate_difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

namespace rcme {
namespace {

using Numbers = std::vector<std::pair<std::string, double>>;  // name, value

template <typename Matrix>
void Add(const std::string& name, const Matrix& matrix, Numbers* numbers) {
  for (Eigen::Index r = 0; r < matrix.rows(); ++r) {
    for (Eigen::Index c = 0; c < matrix.cols(); ++c)
      numbers->emplace_back(fmt::format("{}({}, {})", name, r, c), matrix(r, c));
  }
}

Numbers ListComparedNumbers(const MotionEstimate& e) {
  Numbers numbers = {{"status", static_cast<double>(e.status)},
                     {"num_support", e.num_support},
                     {"mean_entropy", e.mean_entropy},
                     {"z_statistic", e.z_statistic},
                     {"num_consistent_before", e.num_consistent_before},
                     {"num_consistent_after", e.num_consistent_after},
                     {"failed_by_kappa", e.failed_by_kappa},
                     {"num_explained", e.num_explained},
                     {"num_hypotheses", e.counts.num_hypotheses},
                     {"num_degenerate_samples", e.counts.num_degenerate_samples},
                     {"num_inconsistent_samples", e.counts.num_inconsistent_samples},
                     {"num_poor_inlier_sets", e.counts.num_poor_inlier_sets},
                     {"num_too_small_inlier_sets", e.counts.num_too_small_inlier_sets},
                     {"num_candidates", e.counts.num_candidates},
                     {"model of the hypothesis", e.hypothesis.model},
                     {"size of its sample", e.hypothesis.sample.size()},
                     {"failure_probability", e.failure_probability},
                     {"sigma_estimated_px", e.sigma_estimated_px},
                     {"sigma_estimated_sd_px", e.sigma_estimated_sd_px},
                     {"doubt", static_cast<double>(e.doubt)},
                     {"number of other modes", static_cast<double>(e.other_modes.size())},
                     {"number of inlier probabilities", static_cast<double>(e.inlier_probabilities.size())},
                     {"number of inliers", static_cast<double>(e.inliers.size())}};
  Add("R", e.cam2_from_cam1.R, &numbers);
  Add("t", e.cam2_from_cam1.t, &numbers);
  Add("pose_cov", e.pose_cov, &numbers);
  Add("initial R", e.initial_pose.R, &numbers);
  Add("initial t", e.initial_pose.t, &numbers);
  for (const int index : e.hypothesis.sample) numbers.emplace_back("a match of the sample", index);
  for (const int index : e.inliers) numbers.emplace_back("an inlier", index);
  for (const double p : e.inlier_probabilities) numbers.emplace_back("an inlier probability", p);
  for (const MotionMode& mode : e.other_modes) {
    Add("R of a mode", mode.cam2_from_cam1.R, &numbers);
    Add("t of a mode", mode.cam2_from_cam1.t, &numbers);
    Add("pose_cov of a mode", mode.pose_cov, &numbers);
    numbers.emplace_back("weight of a mode", mode.weight);
    numbers.emplace_back("explained share of a mode", mode.explained_share);
  }
  return numbers;
}

Numbers ListComparedNumbers(const MotionProblem& problem) {
  Numbers numbers = {{"sigma_px", problem.sigma_px},
                     {"number of matches", static_cast<double>(problem.matches.size())}};
  numbers.emplace_back("number of noise scales", static_cast<double>(problem.noise_scale.size()));
  for (const double scale : problem.noise_scale) numbers.emplace_back("a noise scale", scale);
  for (const Camera& c : {problem.camera1, problem.camera2}) {
    for (const double x : {c.fx, c.fy, c.cx, c.cy, 1.0 * c.width, 1.0 * c.height})
      numbers.emplace_back("a number of a camera", x);
  }
  for (const Correspondence& match : problem.matches) {
    for (const double x : {match.x1_px.x(), match.x1_px.y(), match.x2_px.x(), match.x2_px.y()})
      numbers.emplace_back("a coordinate", x);
  }
  return numbers;
}

std::optional<std::string> FirstDifference(const Numbers& a, const Numbers& b) {
  const auto is_same = [](const auto& x, const auto& y) {
    return std::bit_cast<std::uint64_t>(x.second) == std::bit_cast<std::uint64_t>(y.second);
  };
  const auto [in_a, in_b] = std::mismatch(a.begin(), a.end(), b.begin(), b.end(), is_same);
  // their lengths were compared among the numbers
  if (in_a == a.end() || in_b == b.end()) return std::nullopt;
  return fmt::format("{} is {} and then {}", in_a->first, in_a->second, in_b->second);
}

}  // namespace

std::optional<std::string> FirstDifference(const MotionEstimate& a, const MotionEstimate& b) {
  if (a.message != b.message) return fmt::format("the message is '{}' and then '{}'", a.message, b.message);
  return FirstDifference(ListComparedNumbers(a), ListComparedNumbers(b));
}

std::optional<std::string> FirstDifference(const MotionProblem& a, const MotionProblem& b) {
  return FirstDifference(ListComparedNumbers(a), ListComparedNumbers(b));
}

}  // namespace rcme
