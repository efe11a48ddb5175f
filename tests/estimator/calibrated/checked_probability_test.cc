// What is made of the check: the formula, its order in the posterior, and that names and constants belong
// together.
#include "estimator/calibrated/checked_probability.h"

#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <vector>

#include "estimator/calibrated/fitted_constants.h"
#include "stats/random.h"

namespace rcme {
namespace {

ModelCheck RandomCheck(RandomStream& rng) {
  ModelCheck c;
  c.log_noise_ratio = rng.Normal();
  c.neighbour_correlation = 2.0 * rng.Uniform() - 1.0;
  c.neighbour_z = 3.0 * rng.Normal();
  c.planar_share = rng.Uniform();
  c.spread_in_matches = 3.0 * rng.Uniform() - 2.0;
  c.spread_in_image = 4.0 * rng.Uniform() - 3.0;
  c.log_parallax_share = std::log(0.01 + 0.99 * rng.Uniform());
  c.log_design_2 = rng.Normal();
  c.log_design_4 = rng.Normal();
  c.wrong_share = rng.Uniform();
  c.wrong_coherence = rng.Uniform();
  c.log_rotation_sd = -4.0 + 2.0 * rng.Normal();
  c.num_rivals = std::floor(7.0 * rng.Uniform());
  c.greatest_rival = rng.Uniform();
  c.direction_mass = rng.Uniform();
  c.low_depth = 6.0 * rng.Uniform() - 3.0;
  return c;
}

TEST(CheckedProbability, ConstantsAreOfTheirTerms) {
  const auto expect_names = [](const std::vector<FitTerm>& terms, std::span<const FittedTerm> constants) {
    ASSERT_EQ(terms.size(), constants.size()) << "run scripts/fit_calibrated";
    for (size_t k = 0; k < terms.size(); ++k) EXPECT_EQ(terms[k].name, constants[k].name);
  };
  expect_names(ListFailureTerms(0.5, {}), kFailureTerms);
  expect_names(ListSpreadTerms({}), kSpreadTerms);
}

// Where the log-odds are not tempered beyond the least slope, P is the logistic function of the sum of the
// terms; else it lies between that of no evidence and this.
TEST(CheckedProbability, IsLogisticInItsTerms) {
  RandomStream rng({.seed = 1, .purpose = 2910});
  int num_plain = 0;
  for (int i = 0; i < 1000; ++i) {
    const ModelCheck check = RandomCheck(rng);
    const double posterior = std::pow(10.0, -4.0 * rng.Uniform());
    const std::vector<FitTerm> terms = ListFailureTerms(posterior, check);
    double sum = 0.0, of_log_odds = 0.0;
    for (size_t k = 0; k < terms.size(); ++k) {
      const double part = kFailureTerms[k].weight * terms[k].value;
      sum += part;
      if (terms[k].name == "posterior_log_odds" || terms[k].name.starts_with("log_odds_by_"))
        of_log_odds += part;
    }
    const double log_odds = terms[1].value;
    if (log_odds == 0.0 || of_log_odds / log_odds < 0.05) continue;
    ++num_plain;
    EXPECT_NEAR(CheckedFailureProbability(posterior, check), 1.0 / (1.0 + std::exp(-sum)), 1e-12);
  }
  EXPECT_GT(num_plain, 300);
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

// Doubts raise it: each of them alone, from a check without any.
TEST(CheckedProbability, DoubtsRaiseIt) {
  ModelCheck plain;
  plain.log_rotation_sd = -7.0;
  plain.planar_share = 0.3;
  plain.log_parallax_share = -0.5;
  plain.low_depth = 1.0;
  plain.wrong_share = 0.3;
  plain.partner_dependence = 5.0;
  const double p = CheckedFailureProbability(1e-6, plain);
  EXPECT_LT(p, 0.02);
  const auto raised = [&](auto change) {
    ModelCheck check = plain;
    change(check);
    return CheckedFailureProbability(1e-6, check);
  };
  EXPECT_GT(raised([](ModelCheck& c) { c.neighbour_correlation = 0.7, c.neighbour_z = 8.0; }), 1.5 * p);
  EXPECT_GT(raised([](ModelCheck& c) { c.planar_share = 1.0; }), 1.5 * p);
  EXPECT_GT(raised([](ModelCheck& c) { c.log_parallax_share = std::log(0.08); }), 1.5 * p);
  EXPECT_GT(raised([](ModelCheck& c) { c.log_noise_ratio = std::log(3.0); }), 1.5 * p);
  EXPECT_GT(raised([](ModelCheck& c) { c.wrong_coherence = 0.9; }), 1.5 * p);
  EXPECT_GT(raised([](ModelCheck& c) { c.spread_in_matches = -1.0; }), 1.5 * p);
  EXPECT_GT(raised([](ModelCheck& c) { c.partner_dependence = 1.0; }), 3.0 * p);
}

// Noise a hundred times the assumed was in no trial that the constants were fitted to.
TEST(IsInDomain, IsOfWhatTheConstantsWereFittedTo) {
  ModelCheck plain;
  plain.log_rotation_sd = -7.0;
  plain.planar_share = 0.3;
  plain.log_parallax_share = -0.5;
  plain.spread_in_image = -0.3;
  plain.wrong_share = 0.3;
  plain.partner_dependence = 5.0;
  EXPECT_TRUE(IsInDomain(1e-4, plain));
  ModelCheck noisy = plain;
  noisy.log_noise_ratio = std::log(100.0);
  EXPECT_FALSE(IsInDomain(1e-4, noisy));
  ModelCheck vague = plain;
  vague.log_rotation_sd = 1.0;
  EXPECT_FALSE(IsInDomain(1e-4, vague));
  ModelCheck random = plain;  // partners
  random.partner_dependence = 0.0;
  EXPECT_FALSE(IsInDomain(1e-4, random));
}

TEST(CovarianceFactor, IsAtLeastOneAndGrowsWithSharedErrors) {
  RandomStream rng({.seed = 1, .purpose = 2912});
  for (int i = 0; i < 1000; ++i) EXPECT_GE(CovarianceFactor(RandomCheck(rng)), 1.0);
  ModelCheck independent, shared;
  shared.neighbour_z = 9.0;
  shared.log_design_4 = 1.0;
  EXPECT_LT(CovarianceFactor(independent), 1.5);
  EXPECT_GT(CovarianceFactor(shared), 1.3 * CovarianceFactor(independent));
}

}  // namespace
}  // namespace rcme
