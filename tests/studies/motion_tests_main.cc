// What the tests of a refined motion refuse and what they let pass (results/motion_tests):
//   rcme_motion_tests refusals 400 > refusals.csv    each condition, the same trials without and with the
//   tests rcme_motion_tests coverage 400 > coverage.csv    coverage of right answers by the noise's share:
//   why
//                                                    kMostNoiseInDirection is what it is
// Conditions of 20,000 matches get a tenth of the trials. Rates with exact 95 % intervals.
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>
#include <vector>

#include "estimator/observability.h"
#include "stats/distributions.h"
#include "stats/intervals.h"
#include "tests/test_support/motion_outcomes.h"

namespace rcme::motion_tests {
namespace {

std::vector<Condition> AllConditions() {
  std::vector<Condition> all;
  for (const int n : {20, 100, 500, 2000, 20000}) {
    all.push_back({World::kRandom, n, 1.0});
    all.push_back({World::kZeroMotion, n, 0.0});
    for (const double outlier_ratio : {0.0, 0.3, 0.5})
      all.push_back({World::kPureRotation, n, outlier_ratio});
  }
  for (const int n : {20, 100, 500}) {
    for (const double outlier_ratio : {0.0, 0.3, 0.5}) {
      for (const double parallax_deg : {0.2, 1.0, 2.0, 5.0}) {
        all.push_back({World::kParallax, n, outlier_ratio, parallax_deg});
      }
    }
  }
  return all;
}

// A row without trials is left out.
void PrintRow(const std::string& what, const char* quantity, int count, int n) {
  if (n == 0) return;
  const Interval interval = ExactBinomialInterval(count, n);
  fmt::print("{},{},{:.6g},{:.6g},{:.6g},{}\n", what, quantity, 1.0 * count / n, interval.lower,
             interval.upper, n);
}

void PrintRows(const Condition& c, const std::string& estimator, const Counts& k) {
  std::string name = c.Name();
  std::ranges::replace(name, ',', ';');
  const std::string what = fmt::format("{},{},{}", name, c.num_matches, estimator);
  PrintRow(what, "answers_without_tests", k.ok_untested, k.num_trials);
  PrintRow(what, "answers", k.ok, k.num_trials);
  PrintRow(what, "direction_not_observable", k.not_observable, k.num_trials);
  PrintRow(what, "not_better_than_chance", k.by_chance, k.num_trials);
  if (c.world != World::kParallax) return;
  PrintRow(what, "right_refused_by_chance", k.right_by_chance, k.right_untested);
  PrintRow(what, "right_refused_by_rotation", k.right_by_rotation, k.right_untested);
  PrintRow(what, "right_refused_by_noise", k.right_refused - k.right_by_chance - k.right_by_rotation,
           k.right_untested);
  PrintRow(what, "wrong_refused", k.wrong_refused, k.wrong_untested);
}

void PrintRefusals(int num_trials) {
  fmt::print("matches,num_matches,estimator,quantity,value,lower,upper,n\n");
  for (const Condition& c : AllConditions()) {
    for (const std::string estimator : {"standard", "rcme"}) {
      const int n = c.num_matches > 2000 ? std::max(num_trials / 10, 1) : num_trials;
      PrintRows(c, estimator, CountOutcomes(c, estimator, n));
    }
  }
}

// Of the 95 % region of right answers without the tests, by the noise's share of what determines the
// direction.
void PrintCoverage(int num_trials) {
  constexpr double kEdges[] = {0.05, 0.1, 0.25, 0.4, 0.6, 1e300};
  int num[6] = {}, num_covered[6] = {};
  for (const double parallax_deg : {0.5, 1.0, 2.0}) {
    const Condition condition{World::kParallax, 500, 0.3, parallax_deg};
    const SceneGenerator scenes = MakeScenes(condition);
    for (int t = 0; t < num_trials; ++t) {
      const auto index = static_cast<std::uint32_t>(t);
      const Trial trial = MakeTrial(condition, scenes, index);
      RandomStream rng({1, 14, index, 4});
      const MotionEstimate e = MakeEstimator("standard", false)->Estimate(trial.problem, rng);
      if (e.status != MotionStatus::kOk || !IsRight(e, trial.pose_true)) continue;
      const Eigen::Matrix2d direction_cov = e.pose_cov.bottomRightCorner<2, 2>();
      const double share = NoiseShareOfDirection(
          direction_cov, SumDirectionNoise(trial.problem, e.inliers, e.cam2_from_cam1, direction_cov));
      const Vector5d error = LocalCoordinates(e.cam2_from_cam1, trial.pose_true);
      const auto bin = static_cast<size_t>(std::ranges::lower_bound(kEdges, share) - kEdges);
      ++num[bin];
      num_covered[bin] += error.dot(e.pose_cov.llt().solve(error)) <= ChiSquareQuantile(5, 0.95);
    }
  }
  fmt::print("noise_share,quantity,value,lower,upper,n\n");
  for (size_t bin = 0; bin < 6; ++bin) {
    PrintRow(bin < 5 ? fmt::format("up to {}", kEdges[bin]) : "more", "coverage", num_covered[bin], num[bin]);
  }
}

}  // namespace
}  // namespace rcme::motion_tests

int main(int argc, char** argv) {
  const std::string_view what = argc == 3 ? argv[1] : "", text = argc == 3 ? argv[2] : "";
  int num_trials = 0;
  std::from_chars(text.data(), text.data() + text.size(), num_trials);
  if (num_trials > 0 && what == "refusals") {
    rcme::motion_tests::PrintRefusals(num_trials);
  } else if (num_trials > 0 && what == "coverage") {
    rcme::motion_tests::PrintCoverage(num_trials);
  } else {
    fmt::print(stderr, "usage: rcme_motion_tests refusals|coverage TRIALS > TABLE.csv\n");
    return 2;
  }
  return 0;
}
