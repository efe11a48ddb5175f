// What is made of the check: the formula, its order in the posterior, and that names and constants belong
// together.
#include "estimator/calibrated/checked_probability.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "estimator/calibrated/fitted_constants.h"
#include "stats/random.h"

namespace rcme {
namespace {

ModelCheck RandomCheck(RandomStream& rng) {
  ModelCheck c;
  c.log_noise_ratio = rng.Normal();
  c.neighbour_z = 3.0 * rng.Normal();
  c.planar_share = rng.Uniform();
  c.spread_in_matches = 3.0 * rng.Uniform() - 2.0;
  c.log_parallax_share = std::log(0.01 + 0.99 * rng.Uniform());
  c.log_design_2 = rng.Normal();
  c.log_design_4 = rng.Normal();
  c.wrong_share = rng.Uniform();
  c.wrong_coherence = rng.Uniform();
  c.log_rotation_sd = -4.0 + 2.0 * rng.Normal();
  c.greatest_rival = rng.Uniform();
  c.low_depth = 6.0 * rng.Uniform() - 3.0;
  c.usual_depth = std::exp(2.0 * rng.Normal() + 2.0);
  c.log_num_right = 2.0 + 5.0 * rng.Uniform();
  c.mean_probability = 0.7 + 0.3 * rng.Uniform();
  c.mean_gain = 8.0 * rng.Uniform();
  c.greatest_leverage = rng.Uniform();
  c.log_behind = -8.0 * rng.Uniform();
  c.near_in_right = -rng.Uniform();
  c.parallax_spread = -2.0 * rng.Uniform();
  c.calibration = {std::exp(2.0 * rng.Normal() - 3.0), 10.0 * rng.Uniform(),
                   std::exp(2.0 * rng.Normal() - 4.0)};
  c.partner_dependence = {3.0 * rng.Normal() + 2.0, 3.0 * rng.Normal() + 2.0};
  return c;
}

TEST(CheckedProbability, ConstantsAreOfTheirSigns) {
  const auto expect_known = [](const FittedHinge& hinge) {
    EXPECT_TRUE(std::ranges::any_of(ListCheckSigns({}), [&](const FitTerm& x) {
      return x.name == hinge.sign;
    })) << hinge.sign;
    EXPECT_EQ(std::abs(hinge.direction), 1.0);
  };
  for (const FittedProduct& product : kFailureProducts) {
    expect_known(product.first);
    if (product.has_second) expect_known(product.second);
  }
  const std::vector<FitTerm> signs = ListCheckSigns({});
  ASSERT_EQ(std::size(kSignRanges), signs.size() + 1) << "run scripts/fit_calibrated";
  for (size_t j = 0; j < signs.size(); ++j) EXPECT_EQ(signs[j].name, kSignRanges[j + 1].name);
  const std::vector<FitTerm> of_covariance = ListCovarianceSigns({});
  ASSERT_EQ(of_covariance.size(), std::size(kSpreadTerms));
  for (size_t k = 0; k < of_covariance.size(); ++k) EXPECT_EQ(of_covariance[k].name, kSpreadTerms[k].name);
}

// The formula again, from names.
double ComputeByNames(double posterior, const ModelCheck& check, double* slope) {
  std::map<std::string, double> x;
  for (const FitTerm& sign : ListCheckSigns(check)) x[sign.name] = sign.value;
  for (const FittedRange& range : kSignRanges) {
    if (x.contains(range.name)) x[range.name] = std::min(std::max(x[range.name], range.least), range.most);
  }
  const auto hinge = [&](const FittedHinge& h) {
    const double away = h.direction > 0 ? x.at(h.sign) - h.knot : h.knot - x.at(h.sign);
    return away > 0.0 ? away : 0.0;
  };
  const double log_odds = std::log(posterior) - std::log1p(-posterior);
  double rest = kFailureTerms[0].weight + kFailureTerms[2].weight * posterior;
  *slope = kFailureTerms[1].weight;
  for (const FittedProduct& product : kFailureProducts) {
    const double value =
        product.weight * hinge(product.first) * (product.has_second ? hinge(product.second) : 1.0);
    (product.tempers ? *slope : rest) += value;
  }
  return 1.0 / (1.0 + std::exp(-*slope * log_odds - rest));
}

TEST(CheckedProbability, IsLogisticInItsProducts) {
  RandomStream rng({.seed = 1, .purpose = 2910});
  int num_plain = 0;
  for (int i = 0; i < 1000; ++i) {
    const ModelCheck check = RandomCheck(rng);
    const double posterior = std::pow(10.0, -4.0 * rng.Uniform());
    double slope = 0.0;
    const double expected = ComputeByNames(posterior, check, &slope);
    if (slope < 0.02) continue;  // tempered to the least slope
    ++num_plain;
    EXPECT_NEAR(CheckedFailureProbability(posterior, check), expected, 1e-12);
  }
  EXPECT_GT(num_plain, 60);
}

// Signs beyond the range of the fit count as its ends: a log-odds sum cannot run away with them.
TEST(CheckedProbability, IsThatOfTheEndsBeyondTheRanges) {
  ModelCheck far, farther;
  far.log_noise_ratio = 50.0, farther.log_noise_ratio = 500.0;
  far.mean_gain = -50.0, farther.mean_gain = -5000.0;
  EXPECT_EQ(CheckedFailureProbability(0.1, far), CheckedFailureProbability(0.1, farther));
}

TEST(CheckedProbability, GrowsWithThePosterior) {
  RandomStream rng({.seed = 1, .purpose = 2911});
  for (int i = 0; i < 1000; ++i) {
    const ModelCheck check = RandomCheck(rng);
    double last = CheckedFailureProbability(0.0, check);
    EXPECT_GE(last, 0.0);
    for (const double p : {1e-12, 1e-5, 1e-4, 1e-2, 0.1, 0.4, 0.6, 0.9, 1.0 - 1e-6, 1.0}) {
      const double next = CheckedFailureProbability(p, check);
      EXPECT_GE(next, last) << p;
      last = next;
    }
    EXPECT_LE(last, 1.0);
  }
}

// An answer without any doubt: 300 right matches of 430, spread over the image and in depth.
ModelCheck MakePlainCheck() {
  ModelCheck plain;
  plain.log_rotation_sd = -7.0;
  plain.planar_share = 0.3;
  plain.log_parallax_share = -0.5;
  plain.low_depth = 1.0;
  plain.usual_depth = 60.0;
  plain.log_num_right = std::log(300.0);
  plain.wrong_share = 0.3;
  plain.mean_probability = 0.99;
  plain.mean_gain = 5.0;
  plain.greatest_leverage = 0.1;
  plain.log_behind = -5.0;
  plain.calibration = {0.02, 1.5, 0.004};
  plain.partner_dependence = {5.0, 5.0};
  return plain;
}

// Doubts raise it: each of them alone.
TEST(CheckedProbability, DoubtsRaiseIt) {
  const ModelCheck plain = MakePlainCheck();
  const double p = CheckedFailureProbability(1e-6, plain);
  EXPECT_LT(p, 0.02);
  const auto raised = [&](auto change) {
    ModelCheck check = plain;
    change(check);
    return CheckedFailureProbability(1e-6, check);
  };
  EXPECT_GT(raised([](ModelCheck& c) { c.neighbour_z = 8.0, c.log_design_2 = 2.0, c.log_design_4 = 2.0; }),
            1.5 * p);
  EXPECT_GT(raised([](ModelCheck& c) { c.planar_share = 1.0, c.usual_depth = 4.0; }), 1.5 * p);
  EXPECT_GT(raised([](ModelCheck& c) { c.log_parallax_share = std::log(0.08), c.parallax_spread = -1.0; }),
            1.5 * p);
  EXPECT_GT(raised([](ModelCheck& c) { c.log_noise_ratio = std::log(0.4); }), 1.5 * p);
  // Less than the others: matches that move together are mostly a mode of their own (AddSecondMotion).
  EXPECT_GT(raised([](ModelCheck& c) { c.wrong_coherence = 0.9, c.log_rotation_sd = -6.0; }),
            1.2 * raised([](ModelCheck& c) { c.log_rotation_sd = -6.0; }));
  EXPECT_GT(raised([](ModelCheck& c) { c.spread_in_matches = -1.0; }), 1.5 * p);
  EXPECT_GT(raised([](ModelCheck& c) { c.greatest_rival = 0.3; }), 1.5 * p);
  EXPECT_GT(raised([](ModelCheck& c) { c.calibration = {0.3, 12.0, 0.3}; }), 1.5 * p);
  const auto few = [](ModelCheck& c, double z) {
    c.log_num_right = std::log(12.0), c.partner_dependence = {z, z};
  };
  EXPECT_GT(raised([&](ModelCheck& c) { few(c, 0.2); }), 1.5 * raised([&](ModelCheck& c) { few(c, 3.0); }));
}

// Noise a hundred times the assumed was in no trial that the constants were fitted to.
TEST(IsInDomain, IsOfWhatTheConstantsWereFittedTo) {
  const ModelCheck plain = MakePlainCheck();
  EXPECT_TRUE(IsInDomain(1e-4, plain));
  const auto is_in = [&](auto change) {
    ModelCheck check = plain;
    change(check);
    return IsInDomain(1e-4, check);
  };
  EXPECT_FALSE(is_in([](ModelCheck& c) { c.log_noise_ratio = std::log(100.0); }));
  EXPECT_FALSE(is_in([](ModelCheck& c) { c.log_rotation_sd = 1.0; }));
  EXPECT_FALSE(is_in([](ModelCheck& c) { c.log_num_right = std::log(1e7); }));
  EXPECT_FALSE(is_in([](ModelCheck& c) { c.partner_dependence = {-3.0, -4.0}; }));
}

TEST(CovarianceFactor, IsAtLeastOneAndGrowsWithSharedErrors) {
  RandomStream rng({.seed = 1, .purpose = 2912});
  for (int i = 0; i < 1000; ++i) EXPECT_GE(CovarianceFactor(RandomCheck(rng)), 1.0);
  ModelCheck independent, shared;
  independent.neighbour_z = 1.0;  // as often by chance
  independent.log_design_4 = 0.4;
  shared.neighbour_z = 9.0;
  shared.log_design_4 = 1.0;
  EXPECT_LT(CovarianceFactor(independent), 1.1);
  EXPECT_GT(CovarianceFactor(shared), 1.3 * CovarianceFactor(independent));
}

}  // namespace
}  // namespace rcme
