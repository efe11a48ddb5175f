#include <gtest/gtest.h>

#include <algorithm>

#include "simulator/outlier_registry.h"
#include "simulator/outliers/outlier_laws.h"
#include "tests/simulator/outliers/wrong_matches.h"
#include "tests/test_support/expect_input_error.h"

namespace rcme {
namespace {

// All weights zero but these.
std::unique_ptr<OutlierLaw> MakeMixture(const Settings& weights) {
  auto law = MakeOutlierMixture();
  for (const Parameter& parameter : law->Parameters()) {
    if (parameter.name().starts_with("weight_")) parameter.SetFromText("0");
  }
  return WithSettings(std::move(law), weights);
}

TEST(OutlierMixture, HasAWeightForEveryOtherLaw) {
  const auto law = MakeOutlierMixture();
  for (const OutlierEntry& entry : OutlierRegistry()) {
    if (entry.name != "mixture") {
      EXPECT_NO_THROW(FindParameter(law->Parameters(), "weight_" + entry.name));
    }
  }
}

// Three laws that are easy to distinguish: flagged; sharing a point with a true match; near the true point.
TEST(OutlierMixture, SplitsByTheWeightsToOneMatch) {
  const auto law =
      MakeMixture({{"weight_epipolar", "3"}, {"weight_one_to_many", "2"}, {"weight_displaced", "1"}});
  for (const auto& [num_wrong, expected] :
       {std::pair{60u, std::array{30, 20, 10}}, {61u, std::array{31, 20, 10}}, {1u, std::array{1, 0, 0}}}) {
    const DrawnOutliers wrong = MakeWrong(*law, SceneForOutliers(100), num_wrong, 0.1);
    std::array<int, 3> counts = {0, 0, 0};
    for (size_t i = 0; i < num_wrong; ++i) {
      const bool is_shared =
          std::any_of(wrong.matches.begin() + num_wrong, wrong.matches.end(),
                      [&](const Correspondence& inlier) { return inlier.x1_px == wrong.matches[i].x1_px; });
      ++counts[wrong.is_undetectable[i] ? 0 : is_shared ? 1 : 2];
    }
    EXPECT_EQ(counts, expected) << num_wrong;
  }
}

// With one weight the mixture is that law, to the bit.
TEST(OutlierMixture, OfOneLawIsThatLaw) {
  for (const OutlierEntry& entry : OutlierRegistry()) {
    if (entry.name == "mixture") continue;
    const Scene scene = SceneForOutliers(100);
    const DrawnOutliers alone = MakeWrong(*entry.make(), scene, 50, 0.5);
    const DrawnOutliers mixed = MakeWrong(*MakeMixture({{"weight_" + entry.name, "0.1"}}), scene, 50, 0.5);
    EXPECT_TRUE(std::ranges::equal(alone.matches, mixed.matches, AreEqual)) << entry.name;
    EXPECT_EQ(alone.is_undetectable, mixed.is_undetectable) << entry.name;
  }
}

// A key that two laws have is one key, and sets both.
TEST(OutlierMixture, ASharedKeySetsAllLawsThatHaveIt) {
  const auto law =
      MakeMixture({{"weight_epipolar", "1"}, {"weight_displaced", "1"}, {"outlier_min_shift_px", "20"}});
  const DrawnOutliers wrong = MakeWrong(*law, SceneForOutliers(200), 200);
  for (size_t i = 0; i < 200; ++i) {
    const bool is_on_own_ray = (wrong.matches[i].x1_px - wrong.exact[i].x1_px).norm() < 1e-9;
    if (is_on_own_ray) {
      EXPECT_GT((wrong.matches[i].x2_px - wrong.exact[i].x2_px).norm(), 20.0 - 1e-9);
    }
  }
  EXPECT_TRUE(
      ThrowsInputError([&] { FindParameter(law->Parameters(), "outlier_min_shift_px").SetFromText("-1"); },
                       {"outlier_min_shift_px: '-1' is not allowed"}));
  EXPECT_EQ(FindParameter(law->Parameters(), "outlier_min_shift_px").Value(), "20");
}

TEST(OutlierMixture, WithoutAnyWeightItNamesTheKeys) {
  EXPECT_TRUE(ThrowsInputError([] { MakeWrong(*MakeMixture({}), SceneForOutliers(10), 1); },
                               {"mixture", "weight_uniform", "weight_epipolar"}));
}

}  // namespace
}  // namespace rcme
