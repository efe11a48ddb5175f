#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulator/outliers/outlier_laws.h"
#include "tests/simulator/outliers/wrong_matches.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/goodness_of_fit.h"

namespace rcme {
namespace {

double UniformShiftCdf(double u) { return std::clamp(u, 0.0, 1.0); }

// Where the whole annulus lies in the image, the shift is uniform on its area: squared length and direction
// are uniform. Kolmogorov-Smirnov at 1e-4 each, of about 3,000 shifts; a uniform length is seen.
TEST(DisplacedOutliers, ShiftsAreUniformInTheAnnulus) {
  const auto law =
      WithSettings(MakeDisplacedOutliers(), {{"outlier_min_shift_px", "10"}, {"outlier_max_shift_px", "40"}});
  const Scene scene = SceneForOutliers(5000);
  const DrawnOutliers wrong = MakeWrong(*law, scene, 5000, 0.5);
  std::vector<double> area, length, turn;
  for (size_t i = 0; i < 5000; ++i) {
    EXPECT_EQ(wrong.matches[i].x1_px, wrong.noisy[i].x1_px);
    const Eigen::Vector2d shift_px = wrong.matches[i].x2_px - wrong.noisy[i].x2_px;
    ASSERT_GE(shift_px.norm(), 10.0 - 1e-9);
    ASSERT_LE(shift_px.norm(), 40.0 + 1e-9);
    const Eigen::Vector2d x2_px = wrong.exact[i].x2_px, reach(40.0, 40.0);
    EXPECT_TRUE(scene.camera2.IsInImage(x2_px + shift_px));
    if (!scene.camera2.IsInImage(x2_px + reach) || !scene.camera2.IsInImage(x2_px - reach)) continue;
    area.push_back((shift_px.squaredNorm() - 100.0) / 1500.0);
    length.push_back((shift_px.norm() - 10.0) / 30.0);
    turn.push_back(std::atan2(shift_px.y(), shift_px.x()) / (2.0 * std::numbers::pi) + 0.5);
  }
  EXPECT_GT(area.size(), 2000u);
  EXPECT_GT(TestKolmogorovSmirnov(area, UniformShiftCdf).p_value, 1e-4);
  EXPECT_GT(TestKolmogorovSmirnov(turn, UniformShiftCdf).p_value, 1e-4);
  EXPECT_LT(TestKolmogorovSmirnov(length, UniformShiftCdf).p_value, 1e-10) << "no power";
}

TEST(DisplacedOutliers, AnImpossibleAnnulusNamesTheKeys) {
  const Scene scene = SceneForOutliers(10);
  const auto reversed = WithSettings(MakeDisplacedOutliers(), {{"outlier_max_shift_px", "2"}});
  EXPECT_TRUE(ThrowsInputError([&] { MakeWrong(*reversed, scene, 1); },
                               {"outlier_min_shift_px", "outlier_max_shift_px = 2"}));
  const auto too_far = WithSettings(MakeDisplacedOutliers(),
                                    {{"outlier_min_shift_px", "2000"}, {"outlier_max_shift_px", "3000"}});
  EXPECT_TRUE(ThrowsInputError([&] { MakeWrong(*too_far, scene, 1); },
                               {"outlier_min_shift_px: 2000", "outlier_max_shift_px: 3000"}));
}

}  // namespace
}  // namespace rcme
