// student_t, laplace and contaminated: the laws with longer tails than normal.
#include <gtest/gtest.h>

#include <boost/math/distributions/students_t.hpp>

#include "simulator/noise/noise_laws.h"
#include "stats/distributions.h"
#include "tests/simulator/noise/noise_sample.h"
#include "tests/test_support/goodness_of_fit.h"

namespace rcme {
namespace {

using Cdf = std::function<double(double)>;

// The least of four Anderson-Darling tests, one a coordinate, of 20,000 matches: a false-alarm rate of 4e-4
// where it is compared with 1e-4.
double LawPValue(const NoiseModel& law, const Cdf& cdf) {
  const std::vector<Eigen::Vector4d> noise = SampleNoise(law, 20'000);
  double least = 1.0;
  for (int k = 0; k < 4; ++k) least = std::min(least, TestAndersonDarling(Coordinate(noise, k), cdf).p_value);
  return least;
}

// Whether large errors come together: the mean of e1^2 e2^2, 1 if they do not.
Moments JointSquares(const NoiseModel& law) {
  return ComputeMoments(SampleNoise(law, 100'000),
                        [](const Eigen::Vector4d& e) { return e(0) * e(0) * e(3) * e(3); });
}

// t with `dof` degrees of freedom, scaled to variance 1.
double StudentCdf(double dof, double e) {
  return boost::math::cdf(boost::math::students_t(dof), e / std::sqrt((dof - 2.0) / dof));
}

TEST(StudentNoise, IsStudentsTOfVarianceOne) {
  for (const auto& [text, dof] : {std::pair{"2.5", 2.5}, {"5", 5.0}, {"30", 30.0}}) {
    const auto law = WithSettings(MakeStudentNoise(), {{"sigma_px", "1"}, {"student_dof", text}});
    EXPECT_GT(LawPValue(*law, [&](double e) { return StudentCdf(dof, e); }), 1e-4) << text;
    if (dof > 10.0) continue;  // next to normal
    EXPECT_LT(LawPValue(*law, [&](double e) { return StudentCdf(0.8 * dof, e); }), 1e-4) << "no power";
    EXPECT_LT(LawPValue(*law, NormalCdf), 1e-6) << "no power";
  }
}

// z-test at 1e-4. The multivariate t of 10 degrees of freedom would have a mean of 8 / 6.
TEST(StudentNoise, IsIndependentFromCoordinateToCoordinate) {
  const auto law = WithSettings(MakeStudentNoise(), {{"sigma_px", "1"}, {"student_dof", "10"}});
  const Moments product = JointSquares(*law);
  EXPECT_LT(std::abs(ZAgainst(product, 1.0)), kNoiseZ);
  EXPECT_LT(ZAgainst(product, 8.0 / 6.0), -2.0 * kNoiseZ) << "no power";
}

TEST(LaplaceNoise, IsLaplaceOfVarianceOneAndIndependent) {
  const auto law = WithSettings(MakeLaplaceNoise(), {{"sigma_px", "1"}});
  const auto cdf = [](double scale) {
    return [scale](double e) {
      const double tail = 0.5 * std::exp(-std::abs(e) * std::sqrt(2.0) / scale);
      return e < 0.0 ? tail : 1.0 - tail;
    };
  };
  EXPECT_GT(LawPValue(*law, cdf(1.0)), 1e-4);
  EXPECT_LT(LawPValue(*law, cdf(1.1)), 1e-6) << "no power";
  EXPECT_LT(LawPValue(*law, NormalCdf), 1e-6) << "no power";
  EXPECT_LT(std::abs(ZAgainst(JointSquares(*law), 1.0)), kNoiseZ);
}

// A share p has c times the standard deviation, mean square 1.
TEST(ContaminatedNoise, IsTheMixtureOfGoodAndBadMatches) {
  const auto law =
      WithSettings(MakeContaminatedNoise(),
                   {{"sigma_px", "1"}, {"contaminated_share", "0.2"}, {"contaminated_scale", "4"}});
  const auto cdf = [](double share) {
    return [share](double e) {
      const double good = 1.0 / std::sqrt(1.0 - share + 16.0 * share);
      return (1.0 - share) * NormalCdf(e / good) + share * NormalCdf(e / (4.0 * good));
    };
  };
  EXPECT_GT(LawPValue(*law, cdf(0.2)), 1e-4);
  EXPECT_LT(LawPValue(*law, cdf(0.1)), 1e-6) << "no power";
  EXPECT_LT(LawPValue(*law, NormalCdf), 1e-6) << "no power";
  // A match is bad as a whole: E s^4 = (0.8 + 0.2 * 256) / (0.8 + 0.2 * 16)^2.
  EXPECT_LT(std::abs(ZAgainst(JointSquares(*law), 52.0 / 16.0)), kNoiseZ);
  EXPECT_GT(ZAgainst(JointSquares(*law), 1.0), 2.0 * kNoiseZ) << "no power";
}

TEST(ContaminatedNoise, WithNoneOrAllBadItIsTheGaussianLaw) {
  for (const char* share : {"0", "1"}) {
    const auto law =
        WithSettings(MakeContaminatedNoise(), {{"sigma_px", "1"}, {"contaminated_share", share}});
    EXPECT_GT(LawPValue(*law, NormalCdf), 1e-4);
  }
}

}  // namespace
}  // namespace rcme
