// Whether rcme_calibrated states how often it fails where the model of its modes does not hold, which is what
// its check is for: on conditions drawn at random from ranges that show one sign of the check each.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "experiments/run/run_trials.h"
#include "experiments/study/study_file.h"
#include "experiments/trial/trial.h"
#include "stats/moments.h"

namespace rcme {
namespace {

constexpr int kDraws = 120;  // of each of the ranges, one trial each
constexpr double kSureByModes = 0.1;
constexpr double kMostExcess = 0.03;  // of failures over what is stated, where P is right or cautious

// `given`: the ranges of one sign. Two estimators: with the check, and the modes alone.
StudyPlan DrawConditions(const std::string& given) {
  return MakePlan(
      ParseStudy("name: sign\nseed: 1\ntrials: 1\n"
                 "conditions:\n"
                 "  number: " +
                     std::to_string(kDraws) +
                     "\n"
                     "  ranges:\n"
                     "    motion: {general: {}, forward: {}, sideways: {}, orbit: {}}\n"
                     "    focal_px: [300, 800]\n"
                     "    num_matches: {log: [60, 300]}\n"
                     "    sigma_px: {log: [0.3, 3]}\n" +
                     given +
                     "failure: {max_rotation_error_deg: 3, max_direction_error_deg: 15}\n"
                     "estimators:\n"
                     "  - {name: rcme_calibrated}\n"
                     "  - {name: rcme_calibrated, label: by_modes, options: {leave_out: model_check}}\n",
                 "sign.yaml"));
}

const std::string kBaseline = "parallax_deg: none, baseline_m: {log: [0.02, 0.5]}";
const std::string kCorrelated = "{noise_correlation: [0.8, 0.95], noise_correlation_length_px: [60, 100]}";

std::vector<std::string> ListRangesOfSigns() {
  const std::string deep = "    scene: {uniform_volume: {" + kBaseline + "}}\n";
  return {
      // Neighbours err alike.
      deep + "    noise: {correlated: " + kCorrelated + "}\n    outlier_ratio: [0, 0.6]\n",
      // A plane explains nearly all matches.
      "    scene: {plane: {" + kBaseline +
          ", off_plane_share: [0, 0.1]}}\n"
          "    noise: {gaussian: {}, correlated: " +
          kCorrelated + "}\n    outlier_ratio: [0, 0.6]\n",
      // Few matches hold the parallax.
      "    scene: {far_points: {" + kBaseline +
          "}}\n    far_share: [0.7, 0.9]\n"
          "    outliers: [uniform, moving_object, clustered_both]\n    outlier_ratio: [0, 0.6]\n",
      // Wrong matches move together.
      deep +
          "    outliers: [moving_object, clustered_both, repeated_texture]\n    outlier_ratio: [0.4, 0.8]\n",
  };
}

// Failures less what was stated of them, over some answers.
struct Excess {
  Moments with_check, by_modes;
  void Add(bool has_failed, double p_checked, double p_by_modes) {
    with_check.Add(has_failed - p_checked);
    by_modes.Add(has_failed - p_by_modes);
  }
};

struct MeasuredExcess {
  Excess of_all, of_sure;  // the latter of answers that the modes alone are sure of
};

MeasuredExcess MeasureExcess() {
  MeasuredExcess excess;
  for (const std::string& ranges : ListRangesOfSigns()) {
    const StudyPlan plan = DrawConditions(ranges);
    ForEachTrial(plan, {0, 1}, [&](const Condition& condition, std::uint32_t trial, std::int64_t) {
      const std::vector<TrialRecord> records = RunTrialOfDraw(plan, condition, trial).records;
      const TrialRecord &checked = records[0], &by_modes = records[1];
      if (!IsScored(checked)) return;
      const bool has_failed = HasFailed(checked, plan.study.failure);
      EXPECT_EQ(has_failed, HasFailed(by_modes, plan.study.failure)) << "the check changes the motion";
      excess.of_all.Add(has_failed, checked.failure_probability, by_modes.failure_probability);
      if (by_modes.failure_probability <= kSureByModes)
        excess.of_sure.Add(has_failed, checked.failure_probability, by_modes.failure_probability);
    });
  }
  return excess;
}

// Seeds 1 to 24 gave the means -.058 +- .018, -.009 +- .028 (with the check, of all answers and of the sure),
// .078 +- .017 and .110 +- .029 (by the modes alone; standard deviations over seeds). By normal laws of these
// one of the bounds fails in a seed of 100, a false alarm, and P by the modes alone would be within the
// first two in one of 300: the power is above .996.
TEST(StatedProbability, AgreesWithFailuresWhereThatOfTheModesDoesNot) {
  const auto [of_all, of_sure] = MeasureExcess();
  EXPECT_GT(of_sure.with_check.n(), 80);
  EXPECT_GT(of_all.with_check.mean(), -0.12);
  EXPECT_LT(of_all.with_check.mean(), kMostExcess);
  EXPECT_GT(of_sure.with_check.mean(), -0.1);
  EXPECT_LT(of_sure.with_check.mean(), 0.08);
  EXPECT_GT(of_all.by_modes.mean(), kMostExcess);
  EXPECT_GT(of_sure.by_modes.mean(), kMostExcess);
}

}  // namespace
}  // namespace rcme
