#include "estimator/model_choice/criteria.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "stats/constants.h"
#include "stats/random.h"

namespace rcme {
namespace {

// By hand, n = 4: rho sums to 0.5 + 1 + 3 + 4 = 8.5 where its bound is 4, and to 0.5 + 1 + 2 + 2 = 5.5 where
// it is 2. ln 4 = 1.386294361, ln 16 = 2.772588722.
TEST(Criteria, AreWhatTheirFormulasGiveByHand) {
  const std::vector<double> e2 = {0.5, 1.0, 3.0, 10.0};
  EXPECT_DOUBLE_EQ(AicScore(e2, kRotationDimensions), 8.5 + 2 * 3);
  EXPECT_DOUBLE_EQ(AicScore(e2, kHomographyDimensions), 8.5 + 2 * 8);
  EXPECT_DOUBLE_EQ(AicScore(e2, kEssentialDimensions), 5.5 + 2 * 5);
  EXPECT_DOUBLE_EQ(GicScore(e2, kRotationDimensions), 8.5 + 2 * (2 * 4 + 3));
  EXPECT_DOUBLE_EQ(GicScore(e2, kHomographyDimensions), 8.5 + 2 * (2 * 4 + 8));
  EXPECT_DOUBLE_EQ(GicScore(e2, kEssentialDimensions), 5.5 + 2 * (3 * 4 + 5));
  EXPECT_NEAR(GricScore(e2, kRotationDimensions), 27.908121056, 1e-8);
  EXPECT_NEAR(GricScore(e2, kHomographyDimensions), 41.771064667, 1e-8);
  EXPECT_NEAR(GricScore(e2, kEssentialDimensions), 35.998475945, 1e-8);
  // Three inliers of four whatever the model: 10 is beyond 5.99, and 3 is within 3.84.
  EXPECT_DOUBLE_EQ(PlunderDlScore(e2, kRotationDimensions), 2 * 3 + 4 + 3);
  EXPECT_DOUBLE_EQ(PlunderDlScore(e2, kHomographyDimensions), 2 * 3 + 4 + 8);
  EXPECT_DOUBLE_EQ(PlunderDlScore(e2, kEssentialDimensions), 3 * 3 + 4 + 5);
}

TEST(Criteria, AMatchThatCannotBeIsAsFarOffAsTheBound) {
  for (const auto score : {AicScore, GicScore, GricScore, PlunderDlScore}) {
    EXPECT_EQ(score(std::vector<double>{1.0, kInfinity}, kHomographyDimensions),
              score(std::vector<double>{1.0, 1e6}, kHomographyDimensions));
    EXPECT_TRUE(std::isfinite(score({}, kHomographyDimensions)));
  }
}

// Residuals of n matches: a share `on_plane` of the right ones lies on a plane, a share `wrong` of all is
// wrong.
struct Mixture {
  std::vector<double> homography, essential;
  Mixture(double on_plane, double wrong) {
    constexpr int kNumMatches = 20'000;
    RandomStream rng({.seed = 1, .purpose = 2750});
    for (int i = 0; i < kNumMatches; ++i) {
      const double a = rng.Normal(), b = rng.Normal(), c = rng.Normal();
      const bool is_wrong = i < wrong * kNumMatches;
      const bool is_on_plane = i - wrong * kNumMatches < on_plane * (1.0 - wrong) * kNumMatches;
      homography.push_back(is_wrong || !is_on_plane ? kInfinity : a * a + b * b);
      essential.push_back(is_wrong ? kInfinity : c * c);
    }
  }
  template <typename Score>
  bool IsPlane(Score score) const {
    return score(homography, kHomographyDimensions) < score(essential, kEssentialDimensions);
  }
};

// What the header derives from expectations, to either side of each border.
TEST(Criteria, BordersLieWhereTheDerivationSays) {
  EXPECT_FALSE(Mixture(1.0, 0.0).IsPlane(AicScore));
  for (const double wrong : {0.0, 0.5}) {
    EXPECT_TRUE(Mixture(0.58, wrong).IsPlane(GicScore)) << wrong;
    EXPECT_FALSE(Mixture(0.53, wrong).IsPlane(GicScore)) << wrong;
    EXPECT_TRUE(Mixture(0.53, wrong).IsPlane(PlunderDlScore)) << wrong;
    EXPECT_FALSE(Mixture(0.47, wrong).IsPlane(PlunderDlScore)) << wrong;
  }
  EXPECT_TRUE(Mixture(0.84, 0.0).IsPlane(GricScore));
  EXPECT_FALSE(Mixture(0.80, 0.0).IsPlane(GricScore));
  EXPECT_TRUE(Mixture(1.0, 0.37).IsPlane(GricScore));
  EXPECT_FALSE(Mixture(1.0, 0.42).IsPlane(GricScore));
}

}  // namespace
}  // namespace rcme
