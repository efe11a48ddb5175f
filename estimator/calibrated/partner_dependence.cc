#include "estimator/calibrated/partner_dependence.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rcme {
namespace {

constexpr size_t kMostExplained = 64, kMostPartners = 128;

// One entry per match.
struct Cosines {
  std::vector<double> a, b;
};

double CosineInCamera2(const MotionProblem& problem, const RelativePose& pose, size_t match) {
  return pose.t.dot(problem.camera2.Ray(problem.matches[match].x2_px).normalized());
}

Cosines ComputeCosines(const MotionProblem& problem, const RelativePose& pose, std::span<const size_t> some) {
  const Eigen::Vector3d t_in_camera1 = pose.R.transpose() * pose.t;
  Cosines cosines;
  for (const size_t i : some.first(std::min(some.size(), kMostExplained))) {
    cosines.a.push_back(t_in_camera1.dot(problem.camera1.Ray(problem.matches[i].x1_px).normalized()));
    cosines.b.push_back(CosineInCamera2(problem, pose, i));
  }
  return cosines;
}

int Sign(double x) { return static_cast<int>(x > 0.0) - static_cast<int>(x < 0.0); }

// At b_k, consider the matches that could have had it: a_j < b_k <= b_j. Their a_j are in a random order, so
// that the sum of the signs of a_j - a_k has the variance of a uniform rank.
double TestOrder(const Cosines& c) {
  double sum = 0.0, variance = 0.0;
  for (size_t k = 0; k < c.a.size(); ++k) {
    if (!(c.a[k] < c.b[k])) continue;
    int num_at_risk = 0, sum_of_signs = 0;
    for (size_t j = 0; j < c.a.size(); ++j) {  // without branches, which would be hard to predict
      const int is_at_risk = static_cast<int>(c.a[j] < c.b[k]) & static_cast<int>(c.b[k] <= c.b[j]);
      num_at_risk += is_at_risk;
      sum_of_signs += is_at_risk * Sign(c.a[j] - c.a[k]);
    }
    sum += sum_of_signs;
    variance += (1.0 * num_at_risk * num_at_risk - 1.0) / 3.0;
  }
  return variance > 0.0 ? sum / std::sqrt(variance) : 0.0;
}

// `partners` holds the b of all matches in ascending order. Among those greater than a_i, b_i has a uniform
// rank; equal ones share theirs.
double TestRank(const Cosines& c, const std::vector<double>& partners) {
  double sum = 0.0, variance = 0.0;
  for (size_t i = 0; i < c.a.size(); ++i) {
    if (!(c.a[i] < c.b[i])) continue;
    const auto greater = std::upper_bound(partners.begin(), partners.end(), c.a[i]);
    const auto [equal, beyond] = std::equal_range(greater, partners.end(), c.b[i]);
    const auto num_greater = static_cast<double>(partners.end() - greater);
    if (num_greater < 2.0) continue;
    const double rank = static_cast<double>(equal - greater) + 0.5 * static_cast<double>(beyond - equal);
    sum += 0.5 - rank / num_greater;
    variance += (1.0 - 1.0 / (num_greater * num_greater)) / 12.0;
  }
  return variance > 0.0 ? sum / std::sqrt(variance) : 0.0;
}

}  // namespace

PartnerDependence FindPartnerDependence(const MotionProblem& problem, const RelativePose& pose,
                                        std::span<const size_t> some) {
  const Cosines cosines = ComputeCosines(problem, pose, some);
  std::vector<double> partners;
  for (size_t i = 0; i < std::min(problem.matches.size(), kMostPartners); ++i)
    partners.push_back(CosineInCamera2(problem, pose, i));
  std::ranges::sort(partners);
  return {TestOrder(cosines), TestRank(cosines, partners)};
}

}  // namespace rcme
