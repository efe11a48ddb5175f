#include "experiments/real/truth_check/truth_reach.h"

#include <gtest/gtest.h>

#include "stats/constants.h"
#include "stats/distributions.h"
#include "stats/random.h"

namespace rcme {
namespace {

const RelativePose kGiven = Retract({}, (Vector5d() << 0.1, -0.2, 0.05, 0.3, 0.1).finished());

RelativePose Moved(double rotation_deg, double direction_deg) {
  return Retract(kGiven, kRadPerDeg * (Vector5d() << 0.0, rotation_deg, 0.0, 0.0, direction_deg).finished());
}
double RotationDeg(const RelativePose& pose) { return RotationAngleBetween(pose.R, kGiven.R) / kRadPerDeg; }
double DirectionDeg(const RelativePose& pose) { return AngleBetween(pose.t, kGiven.t) / kRadPerDeg; }

TEST(TruthReach, WithoutAStatementGoesAsFarAsTheBounds) {
  const TruthReach reach({kGiven}, {3.0, 15.0}, Matrix5d::Zero());
  const RelativePose within = reach.Clip(Moved(2.9, 14.0));
  EXPECT_NEAR(RotationDeg(within), 2.9, 1e-9);
  EXPECT_NEAR(DirectionDeg(within), 14.0, 1e-9);
  const RelativePose clipped = reach.Clip(Moved(30.0, 40.0));
  EXPECT_NEAR(RotationDeg(clipped), 3.0, 1e-9);
  EXPECT_NEAR(DirectionDeg(clipped), 15.0, 1e-9);
  EXPECT_FALSE(IsBeyond({3.0, 15.0}, {kGiven}, Moved(2.9, 14.9)));
  EXPECT_TRUE(IsBeyond({3.0, 15.0}, {kGiven}, Moved(3.1, 0.0)));
  EXPECT_TRUE(IsBeyond({3.0, 15.0}, {kGiven}, Moved(0.0, 15.1)));
}

TEST(TruthReach, ADirectionThatIsNotGivenIsAnywhere) {
  const GivenTruth truth{kGiven, TruthSd{Eigen::Vector3d::Constant(1e-4), Eigen::Vector3d::Zero()}, false};
  const RelativePose clipped = TruthReach(truth, {3.0, 15.0}, Matrix5d::Zero()).Clip(Moved(30.0, 120.0));
  EXPECT_NEAR(RotationDeg(clipped), 3.0, 1e-9);
  EXPECT_NEAR(DirectionDeg(clipped), 120.0, 1e-9);
  EXPECT_FALSE(IsBeyond({3.0, 15.0}, truth, Moved(0.0, 120.0)));
}

// Along one axis of the rotation the region of 99.9 % ends at sqrt(chi2_5(.999)) = 4.53 standard deviations
// (R: sqrt(qchisq(.999, 5))), those of the truth and the calibration together.
TEST(TruthReach, AStatementGoesAsFarAsItsRegion) {
  const TruthSd sd{Eigen::Vector3d::Constant(0.3 * kRadPerDeg), Eigen::Vector3d::Constant(0.01)};
  const TruthReach stated({kGiven, sd}, {3.0, 15.0}, Matrix5d::Zero());
  EXPECT_NEAR(RotationDeg(stated.Clip(Moved(30.0, 0.0))), 4.5293 * 0.3, 1e-3);
  EXPECT_NEAR(RotationDeg(stated.Clip(Moved(1.35, 0.0))), 1.35, 1e-9);
  const Matrix5d calibration_cov = std::pow(0.4 * kRadPerDeg, 2) * Matrix5d::Identity();
  const TruthReach wider({kGiven, sd}, {3.0, 15.0}, calibration_cov);
  EXPECT_NEAR(RotationDeg(wider.Clip(Moved(30.0, 0.0))), 4.5293 * 0.5, 1e-3);
}

// Of a truth that is exact, and says so: only what rounds.
TEST(TruthReach, OfAnExactTruthIsThatTruth) {
  const TruthReach exact({kGiven, TruthSd{}}, {3.0, 15.0}, Matrix5d::Zero());
  EXPECT_LT(RotationDeg(exact.Clip(Moved(30.0, 5.0))), 1e-4);
}

}  // namespace
}  // namespace rcme
