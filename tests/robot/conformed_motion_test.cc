// The robot's header with a file of `rcme conform`: covariance, probability and refusals are those of the
// file.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "estimator/conform/conform_file.h"
#include "robot/two_view.h"
#include "stats/random.h"
#include "tests/estimator/conform/conform_examples.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

class ConformedMotion : public testing::Test {
 protected:
  ConformedMotion() {
    options_.K1 = options_.K2 = (cv::Mat_<double>(3, 3) << 600, 0, 319.5, 0, 600, 239.5, 0, 0, 1);
    options_.size1 = options_.size2 = cv::Size(640, 480);
    options_.estimator = "standard";
    options_.options = {{"num_iterations", "50"}};
    RandomStream rng({.seed = 1, .purpose = 80});
    for (int i = 0; i < 100; ++i) {  // moved by (1, 0, 0)
      const double z = rng.Uniform(4.0, 12.0), x = 319.5 + rng.Uniform(-200, 200), y = rng.Uniform(50, 430);
      points1_.emplace_back(static_cast<float>(x + 0.3 * rng.Normal()), static_cast<float>(y));
      points2_.emplace_back(static_cast<float>(x + 600.0 / z), static_cast<float>(y + 0.3 * rng.Normal()));
    }
  }
  TwoViewMotion Estimate(const ConformRule& rule) {
    options_.conform = folder_.Write("x.conform.json", ConformFileText(rule, {}));
    return TwoViewInitializer(options_).Estimate(points1_, points2_);
  }
  // One stratum, and odds that do not depend on what is seen.
  static ConformRule Plain(double factor, double log_odds) {
    ConformRule rule = ExampleRule();
    rule.difficulty = rule.failure = {};
    rule.edges.clear();
    rule.factors = {factor};
    rule.log_odds_intercept = log_odds;
    return rule;
  }

  TempFolder folder_;
  TwoViewOptions options_;
  std::vector<cv::Point2f> points1_, points2_;
};

TEST_F(ConformedMotion, HasTheFilesCovarianceAndProbability) {
  const TwoViewMotion own = TwoViewInitializer(options_).Estimate(points1_, points2_),
                      good = Estimate(Plain(9.0, -5.0));
  ASSERT_EQ(own.status, "ok");
  EXPECT_EQ(own.verdict, TwoViewVerdict::kDoubtful);  // standard states no probability
  EXPECT_EQ(good.verdict, TwoViewVerdict::kGood) << good.message;
  EXPECT_EQ(cv::norm(good.R, own.R), 0.0);
  EXPECT_NEAR(cv::norm(good.covariance, 9.0 * own.covariance), 0.0, 1e-12 * cv::norm(good.covariance));
  EXPECT_NEAR(good.failure_probability, 1.0 / (1.0 + std::exp(5.0)), 1e-12);
  EXPECT_EQ(good.probability_domain, "not_stated");  // 21 answers cannot call one strange
  EXPECT_EQ(Estimate(Plain(9.0, 0.0)).verdict, TwoViewVerdict::kDoubtful);
}

TEST_F(ConformedMotion, IsRefusedAsTheFileSays) {
  ConformRule rule = Plain(1.0, -5.0);
  rule.greatest_log_odds.reset();
  const TwoViewMotion refused = Estimate(rule);
  EXPECT_EQ(refused.verdict, TwoViewVerdict::kRefused);
  EXPECT_EQ(refused.status, "too_uncertain");
}

TEST_F(ConformedMotion, NeedsAFileThatIsOne) {
  options_.conform = folder_.Path("none.json");
  EXPECT_THROW(TwoViewInitializer{options_}, std::runtime_error);
  options_.conform = folder_.Write("bad.json", "{}");
  EXPECT_THROW(TwoViewInitializer{options_}, std::runtime_error);
}

}  // namespace
}  // namespace rcme
