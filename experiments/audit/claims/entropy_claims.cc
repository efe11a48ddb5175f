#include <cmath>

#include "estimator/ransac_estimate.h"
#include "estimator/sample_consistency.h"
#include "experiments/audit/claims/calibration.h"
#include "experiments/audit/claims/call_estimator.h"
#include "experiments/audit/claims/design.h"
#include "experiments/audit/claims/families.h"
#include "experiments/audit/claims/model_entropy.h"
#include "stats/constants.h"
#include "stats/distributions.h"
#include "stats/moments.h"

namespace rcme {
namespace {

const Sample kFirstEight = {0, 1, 2, 3, 4, 5, 6, 7};
const char* const kEntropyLabel = "eq::score-inliers";

// The same problem with pixels of half the size: every coordinate and sigma is doubled.
MotionProblem InHalfPixels(MotionProblem problem) {
  for (Camera* camera : {&problem.camera1, &problem.camera2}) {
    camera->fx *= 2.0, camera->fy *= 2.0, camera->cx *= 2.0, camera->cy *= 2.0;
    camera->width *= 2, camera->height *= 2;
  }
  for (Correspondence& match : problem.matches) match.x1_px *= 2.0, match.x2_px *= 2.0;
  problem.sigma_px *= 2.0;
  return problem;
}

// For half pixels: whether psi stays the same, by how many log 2 it shifts (NaN without inliers), and whether
// the quality test's verdict stays the same.
template <typename PointTest>
Statistic UnitStatistic(Reading reading) {
  RansacOptions options;
  options.reading = reading;
  return [options](Case& made) -> Outcome {
    const InlierScore score = ScoreSample<PointTest>(made.problem(), kFirstEight);
    const InlierScore scaled = ScoreSample<PointTest>(InHalfPixels(made.problem()), kFirstEight);
    const double normal = NormalQuantile(1.0 - options.significance_level);
    const auto passes = [&](const InlierScore& each) {
      return PassesQualityTest(ZStatistic(each, options.MuOrDefault()), normal, options.quality_test);
    };
    const double same_verdict = passes(score) == passes(scaled) ? 1.0 : 0.0;
    if (score.num_inliers == 0) return {kNaN, kNaN, same_verdict};
    const double shift = scaled.mean_entropy - score.mean_entropy;
    return {std::abs(shift) <= 1e-6 ? 1.0 : 0.0, shift / std::log(2.0), same_verdict};
  };
}

std::vector<Target> UnitTargets() {
  return {PlannedRate("share of models with the same psi", 1.0, kIdentity, 0),
          MeasuredMean("shift of psi over log 2", 1),
          PlannedRate("share of models with the same verdict", 1.0, kIdentity, 2)};
}

// The printed entropy h of a match is 3 log|e| plus another part, e the signed Sampson distance (px).
struct EntropyParts {
  Moments whole, residual;
  double sum_products = 0.0;  // of h and its residual part
  void Add(double h, double log_residual) {
    whole.Add(h), residual.Add(log_residual);
    sum_products += h * log_residual;
  }
  // Share of the variance of the whole that the residual part explains: Cov(whole, residual) / Var(whole).
  double ResidualShare() const {
    const double n = static_cast<double>(whole.n());
    return (sum_products - n * whole.mean() * residual.mean()) / ((n - 1.0) * whole.variance());
  }
};

// Share of the residual part in the variance of h among the inliers of a model (mean over the models), and in
// the variance of psi among twenty models of one scene.
Outcome ResidualShareStatistic(Case& made) {
  constexpr int kNumModels = 20;
  const MotionProblem& problem = made.problem();
  const double threshold = Thresholds::For(problem, RansacOptions(), 3).point;
  EntropyParts among_models;
  Moments within_models;
  for (int i = 0; i < kNumModels; ++i) {
    const std::optional<UncertainFundamental> model =
        ComputeSampleModel(problem, DrawSampleByKind(SampleKind::kGood, made));
    if (!model) continue;
    const AsPrintedTest test(*model, problem.sigma_px);
    EntropyParts within;
    for (const Correspondence& match : problem.matches) {
      PointResidual residual;
      if (!(test.Distance(match, &residual) <= threshold)) continue;
      within.Add(test.Entropy(residual), 1.5 * std::log(SquaredSampsonDistance(model->F, match)));
    }
    if (within.whole.n() < 3) continue;
    within_models.Add(within.ResidualShare());
    among_models.Add(within.whole.mean(), within.residual.mean());
  }
  if (among_models.whole.n() < 3) return {kNaN, kNaN};
  return {within_models.mean(), among_models.ResidualShare()};
}

// Rank-aware inliers whose score is the printed entropy, or one of its two parts.
enum class EntropyPart { kWhole, kResidual, kRest };
template <EntropyPart part>
class PrintedEntropyTest {
 public:
  static constexpr bool kNeedsCovariance = true;
  static constexpr int kDegreesOfFreedom = 1;
  static constexpr int SampleTestDof(int solver_dof) { return solver_dof; }
  static constexpr bool kScoresExactFits = false;
  PrintedEntropyTest(const UncertainFundamental& model, double sigma_px)
      : rank_aware_(model, sigma_px), as_printed_(model, sigma_px) {}

  double Distance(const Correspondence& match, PointResidual* residual) const {
    const double d2 = rank_aware_.Distance(match, residual);
    const double log_residual = 1.5 * (std::log(d2) + residual->log_det_cov);  // 3 log|e|, e^2 = d2 s2
    PointResidual printed;
    as_printed_.Distance(match, &printed);
    const double whole = as_printed_.Entropy(printed);
    residual->log_det_cov = part == EntropyPart::kWhole      ? whole
                            : part == EntropyPart::kResidual ? log_residual
                                                             : whole - log_residual;
    return d2;
  }
  double Entropy(const PointResidual& residual) const { return residual.log_det_cov; }
  double NegativeLogLikelihood(const PointResidual&) const { return 0.0; }

 private:
  RankAwareTest rank_aware_;
  AsPrintedTest as_printed_;
};

// RCME with the joint sample test and without the quality test. The variants differ only in the score that
// selects.
template <typename PointTestT>
struct SelectionDecision {
  using PointTest = PointTestT;
  static constexpr bool kTestsSample = true;
  static bool SampleIsConsistent(const MotionProblem&, const Hypothesis<EightPoint>& hypothesis,
                                 const PointTest&, const Thresholds& thresholds) {
    return JointSampleStatistic(hypothesis) <= thresholds.sample;
  }
  SelectionDecision(const RansacOptions& options, const Thresholds&)
      : selected_by(FindDecidingScore(options.selection)) {}
  bool AcceptsInlierSet(double) const { return true; }
  DecidingScore deciding_score() const { return selected_by; }
  DecidingScore selected_by;
};

template <typename PointTest>
bool SelectionFails(const Case& made, Selection selection) {
  RansacOptions options;
  options.selection = selection;
  RandomStream sampling_rng = StreamFor(made.name, StreamPurpose::kSampling);
  using Decision = SelectionDecision<PointTest>;
  const MotionEstimate estimate = EstimateByRansac<Decision, ReferenceEngine<Decision, EightPoint>>(
      made.problem(), options, sampling_rng);
  return FailsOrRefuses(Score(estimate, made.data, 0.0));
}

Outcome SelectionStatistic(Case& made) {
  const bool whole = SelectionFails<PrintedEntropyTest<EntropyPart::kWhole>>(made, Selection::kMeanEntropy);
  const bool residual =
      SelectionFails<PrintedEntropyTest<EntropyPart::kResidual>>(made, Selection::kMeanEntropy);
  const bool rest = SelectionFails<PrintedEntropyTest<EntropyPart::kRest>>(made, Selection::kMeanEntropy);
  const bool excess = SelectionFails<RankAwareTest>(made, Selection::kMeanEntropy);
  const bool predictive = SelectionFails<RankAwareTest>(made, Selection::kPredictiveLikelihood);
  return {1.0 * (rest && !whole), 1.0 * (excess && !whole), 1.0 * whole, 1.0 * residual, 1.0 * rest,
          1.0 * excess,           1.0 * predictive};
}

std::vector<Target> SelectionTargets() {
  std::vector<Target> targets = {PlannedRate("only the uncertainty part fails", 0.0, kSelection, 0),
                                 PlannedRate("only excess entropy fails", 0.0, kSelection, 1)};
  size_t statistic = 2;
  for (const char* name :
       {"fails by printed psi", "fails by its residual part", "fails by its uncertainty part",
        "fails by excess entropy", "fails by predictive likelihood"}) {
    targets.push_back(MeasuredRate(name, statistic++));
  }
  return targets;
}

}  // namespace

std::vector<CaseClaim> EntropyCalibration() {
  const auto claim = [](const char* id, const char* reading, const char* measured,
                        const Statistic& unit) -> CaseClaim {
    return {{id,
             kEntropyLabel,
             reading,
             "psi and the quality test do not depend on the unit of length",
             measured,
             "",
             {}},
            unit,
            UnitTargets(),
            kIdentity.limits,
            {.matches = MatchesOf::kTruth, .true_motion = false}};
  };
  return {claim("entropy.unit.as_printed", "as printed",
                "psi of all-inlier models in pixels and in half pixels, mu = -3.53",
                UnitStatistic<AsPrintedTest>(Reading::kAsPrinted)),
          claim("entropy.unit.rank_aware", "rank-aware, excess",
                "mean excess entropy of all-inlier models in pixels and in half pixels, mu = 6",
                UnitStatistic<RankAwareTest>(Reading::kRankAware))};
}

std::vector<Claim> EntropyClaims() {
  const Settings pair = {{"num_matches", "100"}};
  const std::vector<CaseClaim> units = EntropyCalibration();
  return {
      OnBuiltInScene(units[0], {pair}),
      OnBuiltInScene(units[1], {pair}),
      {"entropy.residual_share",
       kEntropyLabel,
       "as printed",
       "The printed entropy scores the model's uncertainty, not the residuals (share 0 within 0.1)",
       "Cov(h, 3 log|e|) / Var(h)",
       "",
       {MakeCheck(pair, ResidualShareStatistic,
                  {PlannedMean("share of the residuals in Var h within a model", 0.0, kResidualShare, 0),
                   PlannedMean("share of the residuals in Var psi among models", 0.0, kResidualShare, 1)},
                  kResidualShare.limits)}},
      {"entropy.selection",
       "eq::model_select_entropy",
       "printed psi against its parts",
       "The model's uncertainty alone selects as well: it fails alone in at most 1 % of the trials",
       "failures of RCME (joint sample test, no quality test) that differ in the selecting score alone",
       "",
       {MakeCheck({{"num_matches", "200"}, {"outlier_ratio", "0.2"}}, SelectionStatistic, SelectionTargets(),
                  kSelection.limits)}},
  };
}

}  // namespace rcme
