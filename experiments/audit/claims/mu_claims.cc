#include <fmt/format.h>

#include "estimator/solvers/five_point.h"
#include "experiments/audit/claims/design.h"
#include "experiments/audit/claims/families.h"
#include "experiments/audit/claims/model_entropy.h"
#include "stats/area_under_curve.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

const Settings kPair = {{"num_matches", "200"}, {"outlier_ratio", "0.2"}};

// The inlier set of a good or a contaminated model of one scene.
template <typename PointTest>
InlierScore ScoreDrawnSample(SampleKind kind, Case& made) {
  const Sample sample = DrawSampleByKind(kind, made);
  return ScoreSample<PointTest>(made.problem(), sample);
}

// For a good model of one scene and a contaminated one of another: whether psi orders them, and which of them
// pass the quality test.
template <typename PointTest>
Check SeparationCheck(Reading reading) {
  RansacOptions options;
  options.reading = reading;
  Check check = MakeCheck(kPair, nullptr,
                          {PlannedRate("AUC: a good model has the lower psi", 1.0, kPowerOfTest, 0),
                           PlannedRate("good models that pass", 1.0, kPowerOfTest, 1),
                           PlannedRate("contaminated models that pass", 0.0, kPowerOfTest, 2)},
                          kPowerOfTest.limits);
  check.trial = [cases = SimulatedCases(kPair), options](StreamName name) -> Outcome {
    name.trial *= 2;
    Case first = cases(name);
    ++name.trial;
    Case second = cases(name);
    const InlierScore good = ScoreDrawnSample<PointTest>(SampleKind::kGood, first);
    const InlierScore contaminated = ScoreDrawnSample<PointTest>(SampleKind::kContaminated, second);
    const auto passes = [&](const InlierScore& score) {
      return PassesQualityTest(ZStatistic(score, options.MuOrDefault()),
                               NormalQuantile(1.0 - options.significance_level), options.quality_test);
    };
    return {IsBelow(MeanEntropyOrInfinity(good), MeanEntropyOrInfinity(contaminated), first.rng) ? 1.0 : 0.0,
            passes(good) ? 1.0 : 0.0, passes(contaminated) ? 1.0 : 0.0};
  };
  return check;
}

// Share of the models with psi at most mu, for many mu.
template <typename PointTest>
Check RocCheck(SampleKind kind, const std::vector<double>& thresholds) {
  std::vector<Target> targets;
  for (const double mu : thresholds) {
    Target target = MeasuredRate(fmt::format("psi at most {}", mu));
    target.kind = Target::Kind::kAtMost;
    target.threshold = mu;
    targets.push_back(std::move(target));
  }
  Check check = MakeCheck(
      kPair,
      [kind](Case& made) -> Outcome {
        return {MeanEntropyOrInfinity(ScoreDrawnSample<PointTest>(kind, made))};
      },
      targets, kRoc.limits);
  check.conditions.emplace_back("models", kind == SampleKind::kGood ? "good" : "contaminated");
  return check;
}

template <typename PointTest>
std::vector<Claim> MakeMuClaims(Reading reading, const std::string& id, const std::string& name,
                                const std::string& mu, const std::vector<double>& thresholds) {
  return {{"mu." + id + ".separation",
           "Sec. inlier_qual_test, mu",
           name,
           "psi separates good from contaminated models, and mu = " + mu + " is the right threshold",
           "psi of the models of 8-point samples without and with mismatches, 20 % mismatches",
           "",
           {SeparationCheck<PointTest>(reading)}},
          {"mu." + id + ".roc",
           "Sec. inlier_qual_test, mu",
           name,
           "Receiver operating characteristic over mu",
           "share of models with psi at most mu",
           "",
           {RocCheck<PointTest>(SampleKind::kGood, thresholds),
            RocCheck<PointTest>(SampleKind::kContaminated, thresholds)}}};
}

// The largest inlier set among the five-point models of the first five matches of a sample.
InlierScore FivePointScore(const MotionProblem& problem, const Sample& sample) {
  const Sample first_five = {sample[0], sample[1], sample[2], sample[3], sample[4]};
  const Thresholds thresholds = Thresholds::For(problem, {}, RankAwareTest::kDegreesOfFreedom);
  InlierScore most;
  for (Hypothesis<FivePoint> hypothesis : InstantiateModels<FivePoint>(problem, first_five)) {
    PropagateCovariance(problem, &hypothesis);
    const std::optional<UncertainFundamental> model = ComputeUncertainFundamental(problem, hypothesis);
    if (!model) continue;
    const InlierScore score = ScoreInliers(problem, RankAwareTest(*model, problem.sigma_px), thresholds);
    if (score.num_inliers > most.num_inliers) most = score;
  }
  return most;
}

// Compares psi of good models, eight-point and five-point, each of its own scene.
Claim SolverClaim() {
  const auto pass_at = [](double mu, const std::string& solver, size_t statistic) {
    Target target = MeasuredRate(fmt::format("{}: psi at most {}", solver, mu), statistic);
    target.kind = Target::Kind::kAtMost;
    target.threshold = mu;
    return target;
  };
  Check check =
      MakeCheck(kPair, nullptr,
                {PlannedRate("the five-point model has the higher psi", 0.5, kSameLaw, 0),
                 pass_at(2, "eight-point", 1), pass_at(4, "eight-point", 1), pass_at(6, "eight-point", 1),
                 pass_at(2, "five-point", 2), pass_at(4, "five-point", 2), pass_at(6, "five-point", 2)},
                kPowerOfTest.limits);
  check.trial = [cases = SimulatedCases(kPair)](StreamName name) -> Outcome {
    name.trial *= 2;
    Case first = cases(name);
    ++name.trial;
    Case second = cases(name);
    const double eight = MeanEntropyOrInfinity(ScoreDrawnSample<RankAwareTest>(SampleKind::kGood, first));
    const double five =
        MeanEntropyOrInfinity(FivePointScore(second.problem(), DrawSampleByKind(SampleKind::kGood, second)));
    return {five > eight ? 1.0 : 0.0, eight, five};
  };
  return {"mu.rank_aware.solver",
          "Sec. inlier_qual_test, mu",
          "rank-aware, excess",
          "psi of good models has one law for the eight-point and the five-point solver",
          "psi of models of true matches, 20 % mismatches",
          "",
          {check}};
}

}  // namespace

std::vector<Claim> MuClaims() {
  std::vector<Claim> claims =
      MakeMuClaims<AsPrintedTest>(Reading::kAsPrinted, "as_printed", "as printed", "-3.53",
                                  {-20, -15, -12, -10, -9, -8, -7, -6, -5, -4, -3.53, -3, -2,
                                   -1,  0,   1,   2,   3,  4,  5,  6,  8,  10, 12,    15, 20});
  for (Claim& claim :
       MakeMuClaims<RankAwareTest>(Reading::kRankAware, "rank_aware", "rank-aware, excess", "6",
                                   {0.25, 0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4, 4.5, 5, 6, 7, 8, 10, 12, 15})) {
    claims.push_back(std::move(claim));
  }
  claims.push_back(SolverClaim());
  return claims;
}

}  // namespace rcme
