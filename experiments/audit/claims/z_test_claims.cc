#include <cmath>

#include "experiments/audit/claims/design.h"
#include "experiments/audit/claims/families.h"
#include "experiments/audit/claims/model_entropy.h"
#include "stats/constants.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

constexpr int kSampleSize = 8, kNumTested = 100, kNumForMean = 2000;

// Z of the inliers among a hundred matches, with mu = the model's own mean entropy, which is estimated from
// two thousand others (its error widens Z by 2.5 %).
template <typename PointTest>
double ZAtOwnMean(const Case& made) {
  MotionProblem problem = made.problem();
  // Equal noise: the statistic is that of an estimator that ignores noise scales.
  problem.noise_scale.clear();
  const Sample sample = {0, 1, 2, 3, 4, 5, 6, 7};
  const std::optional<UncertainFundamental> model = ComputeSampleModel(problem, sample);
  if (!model) return kNaN;
  const std::vector<Correspondence> matches = problem.matches;
  const PointTest test(*model, problem.sigma_px);
  const Thresholds thresholds = Thresholds::For(problem, RansacOptions(), PointTest::kDegreesOfFreedom);
  const auto tested_begin = matches.begin() + kSampleSize, tested_end = tested_begin + kNumTested;
  problem.matches.assign(tested_end, matches.end());
  const double mu = ScoreInliers(problem, test, thresholds).mean_entropy;
  problem.matches.assign(tested_begin, tested_end);
  return ZStatistic(ScoreInliers(problem, test, thresholds), mu);
}

template <typename PointTest>
Statistic SizeStatistic(QualityTest quality_test) {
  return [quality_test](Case& made) -> Outcome {
    const double z = ZAtOwnMean<PointTest>(made);
    return {std::isnan(z) ? kNaN : PassesQualityTest(z, NormalQuantile(0.95), quality_test) ? 1.0 : 0.0};
  };
}

template <typename PointTest>
Claim SizeClaim(const char* id, const char* reading, QualityTest quality_test, const char* rule) {
  return {id,
          "eq::inlier-quality-test",
          reading,
          "At psi = mu the test rejects H0 with probability alpha = 0.05 (within 0.03)",
          rule,
          "",
          {MakeCheck({{"num_matches", std::to_string(kSampleSize + kNumTested + kNumForMean)}},
                     SizeStatistic<PointTest>(quality_test),
                     {PlannedRate("share of models that pass", 0.05, kQualityTestLevel)},
                     kQualityTestLevel.limits)}};
}

// Whether the psi of two good models of one scene differ by less than 1.96 of their standard errors
// sqrt(s_j^2 / n_j + s_k^2 / n_k). This holds in 95 % if the entropies of a model are independent draws
// around one mean. NaN if one of them has fewer than two inliers, hence no standard error.
template <typename PointTest>
Outcome SpreadStatistic(Case& made) {
  const InlierScore a = ScoreSample<PointTest>(made.problem(), DrawSampleByKind(SampleKind::kGood, made));
  const InlierScore b = ScoreSample<PointTest>(made.problem(), DrawSampleByKind(SampleKind::kGood, made));
  if (a.num_inliers < 2 || b.num_inliers < 2) return {kNaN};
  const auto squared_error = [](const InlierScore& score) {
    return score.sum_squares / (score.num_inliers - 1.0) / score.num_inliers;
  };
  const double difference = a.mean_entropy - b.mean_entropy;
  return {difference * difference <=
                  1.959963984540054 * 1.959963984540054 * (squared_error(a) + squared_error(b))
              ? 1.0
              : 0.0};
}

template <typename PointTest>
Claim SpreadClaim(const char* id, const char* reading) {
  return {
      id,
      "Sec. inlier_qual_test",
      reading,
      "s / sqrt(n) is the standard error of psi: two all-inlier models of a scene differ by less "
      "than 1.96 of it in 95 %",
      "|psi_j - psi_k| against 1.96 sqrt(s_j^2 / n_j + s_k^2 / n_k)",
      "",
      {MakeCheck({{"num_matches", "100"}}, SpreadStatistic<PointTest>,
                 {PlannedRate("share of pairs within 1.96", 0.95, kStandardError)}, kStandardError.limits)}};
}

}  // namespace

std::vector<Claim> ZTestClaims() {
  const char *kPrintedRule = "Z <= +1.645", *kLevelRule = "Z <= -1.645";
  return {
      SizeClaim<AsPrintedTest>("z_test.size.as_printed", "as printed", QualityTest::kAsPrinted, kPrintedRule),
      SizeClaim<AsPrintedTest>("z_test.size.level_alpha", "printed entropy, right sign",
                               QualityTest::kLevelAlpha, kLevelRule),
      SizeClaim<RankAwareTest>("z_test.size.rank_aware", "excess entropy, right sign",
                               QualityTest::kLevelAlpha, kLevelRule),
      SpreadClaim<AsPrintedTest>("z_test.independence.as_printed", "as printed"),
      SpreadClaim<RankAwareTest>("z_test.independence.rank_aware", "rank-aware, excess"),
  };
}

}  // namespace rcme
