// Estimation taken apart: trace, decide, finish.
#include "estimator/ransac_estimate.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "estimator/estimator_registry.h"
#include "estimator/loop_inspection.h"
#include "tests/test_support/make_ransac.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

MotionProblem MakeProblem(double outlier_ratio, int num_matches, std::uint32_t trial) {
  return TwoCameraProblem(num_matches, 0.5, outlier_ratio, trial);
}

// Few matches refuse, many outliers leave no candidate, identical matches are degenerate.
std::vector<MotionProblem> Problems() {
  std::vector<MotionProblem> problems = {MakeProblem(0.2, 120, 0), MakeProblem(0.5, 120, 1),
                                         MakeProblem(0.8, 60, 2), MakeProblem(0.0, 9, 3),
                                         MakeProblem(0.0, 20, 4)};
  problems.back().matches.resize(7);
  problems.push_back(problems.front());
  std::fill(problems.back().matches.begin() + 1, problems.back().matches.end(), problems.back().matches[0]);
  return problems;
}

RandomStream SamplingStream() { return RandomStream({1, 3, 0, 4}); }

MotionEstimate EstimateWith(const MotionEstimator& estimator, const MotionProblem& problem) {
  RandomStream rng = SamplingStream();
  return estimator.Estimate(problem, rng);
}

void ExpectEqual(const MotionEstimate& a, const MotionEstimate& b) {
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(a.message, b.message);
  EXPECT_EQ(a.cam2_from_cam1.R, b.cam2_from_cam1.R);
  EXPECT_EQ(a.cam2_from_cam1.t, b.cam2_from_cam1.t);
  EXPECT_EQ(a.pose_cov, b.pose_cov);
  EXPECT_EQ(a.inliers, b.inliers);
  EXPECT_EQ(a.num_support, b.num_support);
  EXPECT_EQ(a.mean_entropy, b.mean_entropy);
  EXPECT_EQ(a.z_statistic, b.z_statistic);
  EXPECT_EQ(a.num_consistent_after, b.num_consistent_after);
  EXPECT_EQ(a.num_explained, b.num_explained);
  EXPECT_EQ(a.counts.num_hypotheses, b.counts.num_hypotheses);
  EXPECT_EQ(a.counts.num_inconsistent_samples, b.counts.num_inconsistent_samples);
  EXPECT_EQ(a.counts.num_poor_inlier_sets, b.counts.num_poor_inlier_sets);
  EXPECT_EQ(a.counts.num_candidates, b.counts.num_candidates);
}

std::vector<RansacOptions> BothReadings() {
  std::vector<RansacOptions> both(2);
  both[1].reading = Reading::kRankAware;
  for (RansacOptions& options : both) options.num_iterations = 60;
  return both;
}

TEST(RansacEstimate, EstimateIsFinishOfDecideOfTrace) {
  for (const EstimatorEntry& entry : EstimatorRegistry()) {
    for (RansacOptions options : BothReadings()) {
      for (const Implementation implementation : {Implementation::kFast, Implementation::kReference}) {
        options.implementation = implementation;
        const auto estimator = MakeRansac(entry.name, options);
        const LoopInspection* parts = FindInspection(*estimator);
        ASSERT_NE(parts, nullptr) << entry.name;
        for (const MotionProblem& problem : Problems()) {
          SCOPED_TRACE(entry.name);
          RandomStream rng = SamplingStream();
          Refinements refinements;
          ExpectEqual(parts->Finish(problem, parts->Decide(parts->Trace(problem, rng)), &refinements),
                      EstimateWith(*estimator, problem));
        }
      }
    }
  }
}

// One trace decided under other options is what an estimation with these options gives.
TEST(RansacEstimate, ATraceServesAllDecisionOptions) {
  const std::vector<std::pair<std::string, std::string>> changes = {{"mu", "-1000"},
                                                                    {"mu", "-5"},
                                                                    {"mu", "1.5"},
                                                                    {"mu", "1000"},
                                                                    {"lambda", "0"},
                                                                    {"lambda", "0.9"},
                                                                    {"lambda", "1"},
                                                                    {"inlier_ratio", "0.5"},
                                                                    {"inlier_ratio", "1"},
                                                                    {"quality_test", "level_alpha"},
                                                                    {"early_stop_entropy", "2"},
                                                                    {"early_stop_entropy", "-4"},
                                                                    {"num_iterations", "1"},
                                                                    {"num_iterations", "37"},
                                                                    {"selection", "mean_entropy"},
                                                                    {"num_refined", "5"},
                                                                    {"least_explained_share", "0.45"}};
  for (const MotionProblem& problem : Problems()) {
    for (RansacOptions options : BothReadings()) {
      if (options.reading == Reading::kRankAware) options.selection = Selection::kPredictiveLikelihood;
      const auto traced = MakeRansac("rcme", options);
      RandomStream rng = SamplingStream();
      const HypothesisTrace trace = FindInspection(*traced)->Trace(problem, rng);
      Refinements refinements;  // one set for all
      for (const auto& [key, value] : changes) {
        SCOPED_TRACE(key + " = " + value);
        RansacOptions changed = options;
        FindParameter(AllParameters(changed), key).SetFromText(value);
        const auto estimator = MakeRansac("rcme", changed);
        const LoopInspection* parts = FindInspection(*estimator);
        ExpectEqual(parts->Finish(problem, parts->Decide(trace), &refinements),
                    EstimateWith(*estimator, problem));
      }
    }
  }
}

// Of several refined candidates the one that explains most matches wins, so that more of them explain no
// fewer; in one of these problems they explain more.
TEST(RansacEstimate, MoreRefinedCandidatesExplainNoFewerMatches) {
  int num_better = 0;
  for (std::uint32_t trial = 0; trial < 10; ++trial) {
    const MotionProblem problem = MakeProblem(0.5, 120, trial);
    for (RansacOptions options : BothReadings()) {
      options.mu = 1000.0;
      int previous = 0;
      for (const int num_refined : {1, 3, 20}) {
        options.num_refined = num_refined;
        const MotionEstimate estimate = EstimateWith(*MakeRansac("prcme", options), problem);
        EXPECT_GE(estimate.num_explained, previous);
        num_better += num_refined > 1 && estimate.num_explained > previous;
        previous = estimate.num_explained;
      }
    }
  }
  EXPECT_GT(num_better, 0);
}

// A tie within rounding may part them, rarely.
TEST(RansacEstimate, BothImplementationsChooseTheSameOfSeveralMotions) {
  int num_different = 0;
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    const MotionProblem problem = MakeProblem(0.4, 120, trial);
    for (RansacOptions options : BothReadings()) {
      options.num_refined = 8;
      options.least_explained_share = 0.5;
      const MotionEstimate fast = EstimateWith(*MakeRansac("rcme", options), problem);
      options.implementation = Implementation::kReference;
      const MotionEstimate reference = EstimateWith(*MakeRansac("rcme", options), problem);
      num_different += fast.status != reference.status || fast.num_explained != reference.num_explained ||
                       fast.inliers != reference.inliers;
    }
  }
  EXPECT_LE(num_different, 1);
}

// The motion is refused where it explains less than asked for, and only there.
TEST(RansacEstimate, AMotionThatExplainsTooLittleIsRefused) {
  const MotionProblem problem = MakeProblem(0.2, 120, 0);
  RansacOptions options;
  options.reading = Reading::kRankAware;
  const auto status_at = [&](double share) {
    options.least_explained_share = share;
    return EstimateWith(*MakeRansac("rcme", options), problem).status;
  };
  const double share = EstimateWith(*MakeRansac("rcme", options), problem).num_explained / 120.0;
  EXPECT_GT(share, 0.6);
  EXPECT_LT(share, 0.9);
  EXPECT_EQ(status_at(share), MotionStatus::kOk);
  EXPECT_EQ(status_at(share + 0.005), MotionStatus::kTooFewExplained);
}

// A share that is met exactly is met: 0.55 * 100 is more than 55 in floating point.
TEST(RansacEstimate, AShareThatIsMetExactlyIsEnough) {
  for (const int num_matches : {100, 200, 400, 1000}) {
    for (int num_explained = 1; num_explained <= num_matches; ++num_explained) {
      RansacOptions options;
      options.least_explained_share = std::stod(fmt::format("{:.4f}", 1.0 * num_explained / num_matches));
      MotionEstimate estimate;
      estimate.status = MotionStatus::kOk;
      estimate.num_explained = num_explained;
      CheckExplainedShare(options, num_matches, &estimate);
      ASSERT_EQ(estimate.status, MotionStatus::kOk) << num_explained << " of " << num_matches;
      --estimate.num_explained;
      CheckExplainedShare(options, num_matches, &estimate);
      ASSERT_EQ(estimate.status, MotionStatus::kTooFewExplained) << num_explained << " of " << num_matches;
    }
  }
}

// Of refined candidates that explain as many matches the better one of the loop stays, whose turn is first.
TEST(RansacEstimate, OfEqualMotionsTheFirstStays) {
  LoopResult loop;
  const auto made = [](int index) { return Candidate{{{index}}, {}, 0.0}; };
  loop.winner = made(0);
  loop.runners_up = {made(1), made(2), made(3)};
  const auto chosen = [&](const std::vector<int>& num_explained) {
    return FinishLoop({}, 100, loop,
                      [&](const Candidate& candidate) {
                        MotionEstimate estimate;
                        estimate.status = MotionStatus::kOk;
                        estimate.num_explained = num_explained[static_cast<size_t>(candidate.id.sample[0])];
                        estimate.num_support = candidate.id.sample[0];
                        return estimate;
                      })
        .num_support;
  };
  EXPECT_EQ(chosen({50, 50, 50, 50}), 0);
  EXPECT_EQ(chosen({50, 60, 60, 50}), 1);
  EXPECT_EQ(chosen({50, 49, 51, 50}), 2);
}

// Where nothing is too poor or too small, the winner is the best of all hypotheses by what selects.
TEST(RansacEstimate, TheWinnerIsTheBestByWhatSelects) {
  RansacOptions options;
  options.reading = Reading::kRankAware;
  options.mu = 1000.0;
  options.lambda = 0.0;
  options.num_iterations = 60;
  const MotionProblem problem = MakeProblem(0.3, 120, 0);
  for (const Selection selection : {Selection::kMeanEntropy, Selection::kPredictiveLikelihood}) {
    options.selection = selection;
    const auto estimator = MakeRansac("prcme", options);
    RandomStream rng = SamplingStream();
    const HypothesisTrace trace = FindInspection(*estimator)->Trace(problem, rng);
    const InlierScore winner = FindInspection(*estimator)->Decide(trace).winner.value().score;
    int num_worse = 0;
    for (const ScoredHypothesis& hypothesis : trace.hypotheses) {
      if (hypothesis.score.num_inliers == 0) continue;
      const auto quantity = [&](const InlierScore& score) {
        return selection == Selection::kMeanEntropy ? score.mean_entropy : score.negative_log_likelihood;
      };
      EXPECT_LE(quantity(winner), quantity(hypothesis.score));
      num_worse += quantity(winner) < quantity(hypothesis.score);
    }
    EXPECT_GT(num_worse, 40);
  }
}

TEST(RansacEstimate, AnEmptyLoopIsDegenerateOnlyIfEverySampleIs) {
  LoopCounts counts{.num_hypotheses = 20, .num_degenerate_samples = 20};
  EXPECT_EQ(RefusalFromLoop(counts).status, MotionStatus::kDegenerateMatches);
  counts.num_degenerate_samples = 19;
  counts.num_poor_inlier_sets = 1;
  EXPECT_EQ(RefusalFromLoop(counts).status, MotionStatus::kNoCandidate);
}

// Without entropies there is nothing to stop at: psi is zero for every hypothesis.
TEST(RansacEstimate, StopsEarly) {
  const MotionProblem problem = MakeProblem(0.4, 120, 0);
  RansacOptions options;
  options.reading = Reading::kRankAware;
  options.early_stop_entropy = 100.0;
  EXPECT_LT(EstimateWith(*MakeRansac("prcme", options), problem).counts.num_hypotheses, 10);
}

TEST(RansacEstimate, DecisionOptionsAreOptions) {
  RansacOptions options;
  const std::vector<Parameter> parameters = AllParameters(options);
  for (const char* name : kDecisionOptions) EXPECT_NO_THROW(FindParameter(parameters, name)) << name;
}

// The sample test has its own level; as long as none is given it is alpha.
TEST(RansacEstimate, TheSampleTestHasALevelOfItsOwn) {
  const MotionProblem problem = MakeProblem(0.0, 120, 5);
  for (RansacOptions options : BothReadings()) {
    const auto num_inconsistent = [&](double level) {
      options.sample_significance_level = level;
      return EstimateWith(*MakeRansac("rcme", options), problem).counts.num_inconsistent_samples;
    };
    const int at_alpha = num_inconsistent(std::numeric_limits<double>::quiet_NaN());
    EXPECT_EQ(num_inconsistent(options.significance_level), at_alpha);
    EXPECT_GT(num_inconsistent(0.5), at_alpha);
    EXPECT_LT(num_inconsistent(1e-6), at_alpha);
  }
}

// A change of the unit of length in the image.
MotionProblem InUnits(MotionProblem problem, int scale) {
  for (Correspondence& match : problem.matches) {
    match.x1_px *= scale;
    match.x2_px *= scale;
  }
  for (Camera* camera : {&problem.camera1, &problem.camera2}) {
    camera->fx *= scale;
    camera->fy *= scale;
    camera->cx *= scale;
    camera->cy *= scale;
    camera->width *= scale;
    camera->height *= scale;
  }
  problem.sigma_px *= scale;
  return problem;
}

struct Verdict {
  MotionStatus status;
  int num_candidates, num_poor_inlier_sets, num_inconsistent_samples, num_support;
  std::vector<int> inliers;
  friend bool operator==(const Verdict&, const Verdict&) = default;
};
Verdict ReadVerdict(const RansacOptions& options, const MotionProblem& problem) {
  const MotionEstimate e = EstimateWith(*MakeRansac("rcme", options), problem);
  return {e.status,
          e.counts.num_candidates,
          e.counts.num_poor_inlier_sets,
          e.counts.num_inconsistent_samples,
          e.num_support,
          e.inliers};
}

// Pixels times 1000: excess entropy has no unit, so no verdict may change. A mu among the entropies, so that
// some sets pass and some do not.
TEST(RansacEstimate, RankAwareVerdictsDoNotDependOnTheUnitOfLength) {
  RansacOptions options;
  options.reading = Reading::kRankAware;
  options.mu = 2.0;
  int num_passed = 0, num_poor = 0;
  for (const Selection selection : {Selection::kMeanEntropy, Selection::kPredictiveLikelihood}) {
    options.selection = selection;
    for (std::uint32_t trial = 0; trial < 20; ++trial) {
      const MotionProblem problem = MakeProblem(0.2, 150, trial);
      const Verdict verdict = ReadVerdict(options, problem);
      EXPECT_EQ(verdict, ReadVerdict(options, InUnits(problem, 1000))) << "trial " << trial;
      num_passed += verdict.num_candidates;
      num_poor += verdict.num_poor_inlier_sets;
    }
  }
  EXPECT_GT(num_passed, 50);
  EXPECT_GT(num_poor, 50);
}

// As printed, h grows by 4 log(1000) = 27.6 nats, and mu = -3.53 px refuses everything.
TEST(RansacEstimate, PrintedVerdictsDependOnTheUnitOfLength) {
  const MotionProblem problem = MakeProblem(0.1, 150, 0);
  EXPECT_EQ(ReadVerdict({}, problem).status, MotionStatus::kOk);
  EXPECT_EQ(ReadVerdict({}, InUnits(problem, 1000)).status, MotionStatus::kNoCandidate);
}

}  // namespace
}  // namespace rcme
