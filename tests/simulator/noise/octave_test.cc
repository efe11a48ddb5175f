#include <gtest/gtest.h>

#include "simulator/noise/noise_laws.h"
#include "stats/distributions.h"
#include "tests/simulator/noise/noise_sample.h"
#include "tests/test_support/goodness_of_fit.h"

namespace rcme {
namespace {

// The levels by definition, for sigma_px = 1: P(k) proportional to factor^(-2k), standard deviation
// proportional to factor^k, mean square 1.
struct Pyramid {
  std::vector<double> probabilities, sds;

  Pyramid(int num_levels, double factor) {
    double total = 0.0, mean_square = 0.0;
    for (int k = 0; k < num_levels; ++k) total += std::pow(factor, -2.0 * k);
    for (int k = 0; k < num_levels; ++k) {
      probabilities.push_back(std::pow(factor, -2.0 * k) / total);
      sds.push_back(std::pow(factor, k));
      mean_square += probabilities.back() * sds.back() * sds.back();
    }
    for (double& sd : sds) sd /= std::sqrt(mean_square);
  }
  double Cdf(double e) const {
    double sum = 0.0;
    for (size_t k = 0; k < sds.size(); ++k) sum += probabilities[k] * NormalCdf(e / sds[k]);
    return sum;
  }
  double MeanFourthPower() const {  // of the standard deviation
    double sum = 0.0;
    for (size_t k = 0; k < sds.size(); ++k) sum += probabilities[k] * std::pow(sds[k], 4.0);
    return sum;
  }
};

double PValue(const std::vector<Eigen::Vector4d>& noise, const std::function<double(double)>& cdf) {
  double least = 1.0;
  for (int k = 0; k < 4; ++k) least = std::min(least, TestAndersonDarling(Coordinate(noise, k), cdf).p_value);
  return least;
}

// Anderson-Darling of each coordinate at 1e-4 (4e-4 a case). One level too many, or a plain normal, are seen.
TEST(OctaveNoise, IsTheMixtureOverTheLevelsOfThePyramid) {
  for (const auto& [levels, factor] : {std::pair{8, 1.2}, {3, 2.0}}) {
    const auto law = WithSettings(MakeOctaveNoise(), {{"sigma_px", "1"},
                                                      {"num_octave_levels", std::to_string(levels)},
                                                      {"octave_factor", std::to_string(factor)}});
    const std::vector<Eigen::Vector4d> noise = SampleNoise(*law, 40'000);
    const Pyramid pyramid(levels, factor), deeper(levels + 2, factor);
    EXPECT_GT(PValue(noise, [&](double e) { return pyramid.Cdf(e); }), 1e-4);
    EXPECT_LT(PValue(noise, [&](double e) { return deeper.Cdf(e); }), 1e-6) << "no power";
    EXPECT_LT(PValue(noise, NormalCdf), 1e-6) << "no power";
  }
}

// The mean of e1^2 e2^2 is E s^4 if both images share the level and 1 if they do not; z-test at 1e-4.
TEST(OctaveNoise, HasTheSameLevelInBothImages) {
  const auto law = WithSettings(MakeOctaveNoise(), {{"sigma_px", "1"}});
  const Moments product = ComputeMoments(SampleNoise(*law, 100'000),
                                         [](const Eigen::Vector4d& e) { return e(0) * e(0) * e(3) * e(3); });
  EXPECT_LT(std::abs(ZAgainst(product, Pyramid(8, 1.2).MeanFourthPower())), kNoiseZ);
  EXPECT_GT(ZAgainst(product, 1.0), 2.0 * kNoiseZ) << "no power";
}

// Over what is stated all coordinates are standard normal where it is true; where noise does not grow and the
// detector thinks so, they are normal as they are. Anderson-Darling at 1e-4 a coordinate.
TEST(OctaveNoise, TellsTheTrueSizeOfEachMatchsNoiseUnlessItIsToldWrong) {
  for (const bool is_true : {true, false}) {
    const auto law = WithSettings(MakeOctaveNoise(), {{"sigma_px", "1"},
                                                      {"octave_factor", "1.5"},
                                                      {"octave_growth", is_true ? "0.7" : "0"},
                                                      {"stated_growth", "0.7"}});
    RandomStream rng({.seed = 1, .purpose = 95});
    std::vector<Correspondence> matches(20'000, Correspondence{{0.0, 0.0}, {0.0, 0.0}});
    const std::vector<double> stated = law->AddAndTell(matches, rng);
    ASSERT_EQ(stated.size(), matches.size());
    std::vector<Eigen::Vector4d> own, over_stated;
    double mean_square = 0.0;
    for (size_t i = 0; i < matches.size(); ++i) {
      own.emplace_back(matches[i].x1_px.x(), matches[i].x1_px.y(), matches[i].x2_px.x(),
                       matches[i].x2_px.y());
      over_stated.emplace_back(own.back() / stated[i]);
      mean_square += stated[i] * stated[i] / static_cast<double>(matches.size());
    }
    EXPECT_NEAR(mean_square, 1.0, 0.05);  // sigma_px is the root mean square of what is stated, too
    EXPECT_GT(PValue(is_true ? over_stated : own, NormalCdf), 1e-4);
    EXPECT_LT(PValue(is_true ? own : over_stated, NormalCdf), 1e-6) << "no power";
  }
}

TEST(OctaveNoise, TellsNothingUnlessAsked) {
  RandomStream rng({.seed = 1, .purpose = 96});
  std::vector<Correspondence> matches(3);
  EXPECT_TRUE(MakeOctaveNoise()->AddAndTell(matches, rng).empty());
}

TEST(OctaveNoise, WithOneLevelItIsTheGaussianLaw) {
  const auto law = WithSettings(MakeOctaveNoise(), {{"sigma_px", "1"}, {"num_octave_levels", "1"}});
  EXPECT_GT(PValue(SampleNoise(*law, 20'000), NormalCdf), 1e-4);
}

}  // namespace
}  // namespace rcme
