#include "tests/benchmarks/benchmark_cases.h"

#include <benchmark/benchmark.h>

#include <opencv2/calib3d.hpp>

#include "estimator/estimator_registry.h"
#include "estimator/kernels/agreement.h"
#include "estimator/kernels/block_matches.h"
#include "estimator/kernels/sampson_equations.h"
#include "estimator/problem_check.h"
#include "estimator/reference_matches.h"
#include "estimator/reference_search.h"
#include "estimator/refine_winner.h"
#include "estimator/refinement/reprojection_mle.h"
#include "estimator/sample_consistency.h"
#include "experiments/study/study_file.h"
#include "experiments/trial/trial.h"
#include "stats/distributions.h"
#include "tests/test_support/make_ransac.h"

namespace rcme {
namespace {

using Trial = BenchmarkTrial;
using benchmark::DoNotOptimize;

constexpr double kAlpha = 0.05;

double PointThreshold(int degrees_of_freedom) { return ChiSquareQuantile(degrees_of_freedom, 1.0 - kAlpha); }

void DrawSamples(const Trial& trial) {
  RandomStream rng = StreamFor(trial.name, StreamPurpose::kSampling);
  for (int j = 0; j < kNumHypotheses; ++j) DoNotOptimize(DrawSample(8, trial.blocks.num_matches(), rng));
}

void CheckProblem(const Trial& trial) {
  DoNotOptimize(RefuseUnsolvable(trial.data.problem, EightPoint::kSampleSize));
}

void PackMatches(const Trial& trial) { DoNotOptimize(MatchBlocks(trial.data.problem)); }

template <RequestedOutputs outputs>
void InstantiateFast(const Trial& trial) {
  HypothesisBlock block;
  for (size_t j = 0; j < trial.samples.size(); j += kBlockSize) {
    InstantiateModels(trial.blocks, std::span<const Sample, kBlockSize>(&trial.samples[j], kBlockSize),
                      outputs, &block);
    DoNotOptimize(block);
  }
}

void InstantiateReference(const Trial& trial) {
  for (const Sample& sample : trial.samples)
    DoNotOptimize(InstantiateModel<EightPoint>(trial.data.problem, {sample}));
}

// The joint sample statistic too: the fast one has it from the same pass.
void InstantiateWithCovarianceReference(const Trial& trial) {
  for (const Sample& sample : trial.samples) {
    Hypothesis<EightPoint> hypothesis = InstantiateModel<EightPoint>(trial.data.problem, {sample}).value();
    PropagateCovariance(trial.data.problem, &hypothesis);
    DoNotOptimize(JointSampleStatistic(hypothesis));
  }
}

// All essential matrices through five matches of every sample. Wrong matches take part, as in a search.
void SolveFivePointsFast(const Trial& trial) {
  FivePointModels models;
  for (const FivePointSamples& block : trial.five_point_samples) {
    SolveFivePoints(block, &models);
    DoNotOptimize(models);
  }
}
void SolveFivePointsReference(const Trial& trial) {
  for (const Trial::FiveRays& rays : trial.five_rays)
    DoNotOptimize(FivePoint::Solve(rays.first, rays.second));
}

void TestSamplesFast(const Trial& trial) {
  const double threshold = PointThreshold(AsPrintedTest::kDegreesOfFreedom);
  for (const HypothesisBlock& block : trial.hypothesis_blocks)
    DoNotOptimize(FindConsistentSamples(block, threshold));
}

// Nothing where the covariance is not finite.
template <typename PointTest>
std::optional<PointTest> MakePointTest(const MotionProblem& problem,
                                       const Hypothesis<EightPoint>& hypothesis) {
  if constexpr (!PointTest::kNeedsCovariance) {
    return PointTest(hypothesis.F, problem.sigma_px);
  } else {
    const std::optional<UncertainFundamental> model =
        UncertainFundamental::From(hypothesis.pose, hypothesis.pose_cov, problem.camera1, problem.camera2);
    if (!model) return std::nullopt;
    return PointTest(*model, problem.sigma_px);
  }
}

void TestSamplesReference(const Trial& trial) {
  const double threshold = PointThreshold(AsPrintedTest::kDegreesOfFreedom);
  for (const Hypothesis<EightPoint>& hypothesis : trial.hypotheses) {
    const auto test = MakePointTest<AsPrintedTest>(trial.data.problem, hypothesis);
    if (test) DoNotOptimize(EverySamplePointFits(trial.data.problem, hypothesis, *test, threshold));
  }
}

template <BlockReading reading>
void ScoreFast(const Trial& trial) {
  const double threshold = PointThreshold(reading == BlockReading::kAsPrinted ? 3 : 1);
  InlierScan scan(trial.blocks);
  for (size_t j = 0; j < trial.samples.size(); ++j) {
    const WhitenedModel model(trial.hypothesis_blocks[j / kBlockSize], static_cast<int>(j % kBlockSize));
    if constexpr (reading == BlockReading::kKnownPose) {
      ScanKnownPose(trial.blocks, model.F, threshold, &scan);
    } else if constexpr (reading == BlockReading::kAsPrinted) {
      ScanAsPrinted(trial.blocks, model, threshold, &scan);
    } else {
      ScanRankAware(trial.blocks, model.F, VariancePolynomial(model.dF), threshold, &scan);
    }
    DoNotOptimize(scan.num_inliers);
    if constexpr (reading != BlockReading::kKnownPose) DoNotOptimize(SummarizeEntropies(scan, 0.0));
  }
}

template <typename PointTest>
void ScoreReference(const Trial& trial) {
  const Thresholds thresholds = Thresholds::For(trial.data.problem, {}, PointTest::kDegreesOfFreedom);
  for (const Hypothesis<EightPoint>& hypothesis : trial.hypotheses) {
    const auto test = MakePointTest<PointTest>(trial.data.problem, hypothesis);
    if (test) DoNotOptimize(ScoreInliers(trial.data.problem, *test, thresholds));
  }
}

void ScanPrinted(const Trial& trial) {
  const double threshold = PointThreshold(3);
  InlierScan scan(trial.blocks);
  for (const WhitenedModel& model : trial.models) {
    ScanAsPrinted(trial.blocks, model, threshold, &scan);
    DoNotOptimize(scan.num_inliers);
  }
}

void ScanUncertain(const Trial& trial) {
  const double threshold = PointThreshold(1);
  InlierScan scan(trial.blocks);
  for (size_t j = 0; j < trial.models.size(); ++j) {
    ScanRankAware(trial.blocks, trial.models[j].F, trial.variances[j], threshold, &scan);
    DoNotOptimize(scan.num_inliers);
  }
}

void ExpandVariance(const Trial& trial) {
  for (const WhitenedModel& model : trial.models) DoNotOptimize(VariancePolynomial(model.dF));
}

// Of as many inliers as there are right matches.
void SummarizeEntropiesOfInliers(const Trial& trial) {
  InlierScan scan(trial.blocks);
  scan.num_inliers = static_cast<int>(trial.inliers.size());
  for (size_t i = 0; i < scan.spreads.size(); ++i) scan.spreads[i] = 1.0 + static_cast<double>(i);
  for (int j = 0; j < kNumHypotheses; ++j) DoNotOptimize(SummarizeEntropies(scan, 0.0));
}

void SumLogLikelihoods(const Trial& trial) {
  for (size_t j = 0; j < trial.models.size(); ++j) {
    DoNotOptimize(NegativeLogLikelihood(trial.blocks, trial.models[j].F, trial.variances[j], 6.0));
  }
}

template <Loss loss>
void Linearize(const Trial& trial) {
  DoNotOptimize(LinearizeSampson(trial.blocks, trial.inlier_mask, trial.start, loss));
}

// FindAgreeing and SelectPose of the winner; Matches is BlockMatches or ReferenceMatches.
template <typename Matches>
void FindAgreeingIn(const Matches& matches, const typename Matches::Set& fitted, const Trial& trial) {
  DoNotOptimize(matches.FindAgreeing(trial.refined, fitted, kAlpha));
}
void FindAgreeingFast(const Trial& trial) {
  const BlockMatches matches(trial.data.problem, trial.blocks, RefinementError::kSampson);
  FindAgreeingIn(matches, trial.inlier_mask, trial);
}
void FindAgreeingReference(const Trial& trial) {
  FindAgreeingIn(ReferenceMatches(trial.data.problem, RefinementError::kSampson), trial.inliers, trial);
}

void CountInFrontOfCameras(const Trial& trial) {
  DoNotOptimize(CountInFront(trial.blocks, trial.inlier_mask, trial.start));
}
void SelectPoseFast(const Trial& trial) {
  DoNotOptimize(SelectPoseByCheirality(trial.blocks, trial.inlier_mask, trial.hypotheses[0].projection));
}
void SelectPoseReference(const Trial& trial) {
  const ReferenceMatches matches(trial.data.problem, RefinementError::kSampson);
  DoNotOptimize(matches.SelectPose(trial.hypotheses[0].projection, trial.inliers));
}

void RefineSampson(const Trial& trial) {
  DoNotOptimize(RefineBySampson(trial.blocks, trial.inlier_mask, trial.start, Loss::kSquared));
}
void RefineReprojection(const Trial& trial) {
  DoNotOptimize(RefineByReprojection(trial.data.problem, trial.inliers, trial.start, Loss::kSquared));
}

// From the winner of the loop to the estimate: cheirality, robust fit, refits, final inliers.
template <typename Matches>
void RefineWinnerIn(const Matches& matches, const Trial& trial) {
  MotionEstimate estimate;
  RefineWinner(matches, {}, InstantiateModel<EightPoint>(trial.data.problem, trial.winner),
               matches.MakeSet(ListIndices(trial.support)), &estimate);
  DoNotOptimize(estimate);
}
void RefineWinnerFast(const Trial& trial) {
  RefineWinnerIn(BlockMatches(trial.data.problem, trial.blocks, RefinementError::kSampson), trial);
}
void RefineWinnerReference(const Trial& trial) {
  RefineWinnerIn(ReferenceMatches(trial.data.problem, RefinementError::kReprojection), trial);
}

// Of a motion that passes them, as nearly all do.
template <typename Matches>
void TestMotionIn(const Matches& matches, const Trial& trial) {
  MotionEstimate estimate;
  estimate.status = MotionStatus::kOk;
  estimate.cam2_from_cam1 = trial.refined.cam2_from_cam1;
  estimate.pose_cov = trial.refined.pose_cov;
  estimate.inliers = trial.inliers;
  estimate.num_explained = static_cast<int>(trial.inliers.size());
  RansacOptions options;
  options.reading = Reading::kRankAware;  // as printed there are no such tests
  RefuseByMotionTests(matches, options, &estimate);
  DoNotOptimize(estimate);
}
void TestMotionFast(const Trial& trial) {
  TestMotionIn(BlockMatches(trial.data.problem, trial.blocks, RefinementError::kSampson), trial);
}
void TestMotionReference(const Trial& trial) {
  TestMotionIn(ReferenceMatches(trial.data.problem, RefinementError::kSampson), trial);
}

void FindThresholds(const Trial& trial) { DoNotOptimize(Thresholds::For(trial.data.problem, {}, 3)); }

std::vector<BenchmarkCase> StageCases() {
  const std::string stage = "stage";
  return {{stage, "check_problem", CheckProblem},
          {stage, "pack_matches", PackMatches},
          {stage, "find_thresholds", FindThresholds},
          {stage, "draw_samples", DrawSamples},
          {stage, "instantiate/fast", InstantiateFast<RequestedOutputs::kNone>},
          {stage, "instantiate/reference", InstantiateReference},
          {stage, "instantiate_with_covariance/fast", InstantiateFast<RequestedOutputs::kCovariance>},
          {stage, "instantiate_with_covariance/reference", InstantiateWithCovarianceReference},
          {stage, "five_points/fast", SolveFivePointsFast},
          {stage, "five_points/reference", SolveFivePointsReference},
          {stage, "test_samples/fast", TestSamplesFast},
          {stage, "test_samples/reference", TestSamplesReference},
          {stage, "score_known_pose/fast", ScoreFast<BlockReading::kKnownPose>},
          {stage, "score_known_pose/reference", ScoreReference<KnownPoseTest>},
          {stage, "score_as_printed/fast", ScoreFast<BlockReading::kAsPrinted>},
          {stage, "score_as_printed/reference", ScoreReference<AsPrintedTest>},
          {stage, "score_rank_aware/fast", ScoreFast<BlockReading::kRankAware>},
          {stage, "score_rank_aware/reference", ScoreReference<RankAwareTest>},
          {stage, "scan_as_printed", ScanPrinted},
          {stage, "scan_rank_aware", ScanUncertain},
          {stage, "expand_variance", ExpandVariance},
          {stage, "summarize_entropies", SummarizeEntropiesOfInliers},
          {stage, "negative_log_likelihood", SumLogLikelihoods},
          {stage, "count_in_front", CountInFrontOfCameras},
          {stage, "select_pose/fast", SelectPoseFast},
          {stage, "select_pose/reference", SelectPoseReference},
          {stage, "linearize_sampson_squared", Linearize<Loss::kSquared>},
          {stage, "linearize_sampson_cauchy", Linearize<Loss::kCauchy>},
          {stage, "find_agreeing/fast", FindAgreeingFast},
          {stage, "find_agreeing/reference", FindAgreeingReference},
          {stage, "refine/fast", RefineSampson},
          {stage, "refine/reference", RefineReprojection},
          {stage, "test_motion/fast", TestMotionFast},
          {stage, "test_motion/reference", TestMotionReference},
          {stage, "refine_winner/fast", RefineWinnerFast},
          {stage, "refine_winner/reference", RefineWinnerReference}};
}

std::vector<BenchmarkCase> EstimatorCases() {
  std::vector<BenchmarkCase> cases;
  for (const auto& [label, estimator, reading] : {std::tuple{"standard", "standard", Reading::kAsPrinted},
                                                  {"prcme_as_printed", "prcme", Reading::kAsPrinted},
                                                  {"prcme_rank_aware", "prcme", Reading::kRankAware},
                                                  {"rcme_as_printed", "rcme", Reading::kAsPrinted},
                                                  {"rcme_rank_aware", "rcme", Reading::kRankAware}}) {
    RansacOptions options;
    options.reading = reading;
    cases.push_back(EstimatorCase(label + std::string("/fast"), estimator, options));
    options.implementation = Implementation::kReference;
    options.refinement_error = RefinementError::kReprojection;
    cases.push_back(EstimatorCase(label + std::string("/reference"), estimator, options));
  }
  return cases;
}

BenchmarkCase OpenCvCase(const std::string& name, const std::function<cv::Mat(const Trial&)>& call) {
  return {"peer", name, [call](const Trial& trial) { DoNotOptimize(call(trial)); }};
}

std::vector<BenchmarkCase> OpenCvCases() {
  cv::setNumThreads(1);
  return {OpenCvCase("opencv_ransac_200",
                     [](const Trial& t) {
                       return cv::findFundamentalMat(t.x1, t.x2, cv::FM_RANSAC, 1.0, 0.999999, 200);
                     }),
          OpenCvCase("opencv_usac_magsac",
                     [](const Trial& t) { return cv::findFundamentalMat(t.x1, t.x2, cv::USAC_MAGSAC); }),
          OpenCvCase("opencv_usac_accurate",
                     [](const Trial& t) { return cv::findFundamentalMat(t.x1, t.x2, cv::USAC_ACCURATE); })};
}

// A trial of a study with one estimator: its data made, estimated, scored.
std::vector<BenchmarkCase> TrialCases() {
  const auto plan = std::make_shared<const StudyPlan>(MakePlan(ParseStudy(
      "name: trial\nseed: 1\ntrials: 8\ndata: {scene: uniform_volume, num_matches: 500, outlier_ratio: 0.2, "
      "sigma_px: 0.5, severity: skipped}\nestimators:\n  - {name: rcme}\n",
      "trial")));
  const auto whole = [plan](const Trial& t) {
    DoNotOptimize(RunTrial(*plan, plan->conditions[0], t.name.trial));
  };
  const auto make = [plan](const Trial& t) { DoNotOptimize(plan->conditions[0].source->Make(t.name)); };
  return {{"trial", "whole_trial", whole}, {"trial", "make_data", make}};
}

}  // namespace

BenchmarkCase EstimatorCase(const std::string& name, const std::string& estimator,
                            const RansacOptions& options) {
  const std::shared_ptr<const MotionEstimator> made = MakeRansac(estimator, options);
  return {"estimator", name, [made](const Trial& trial) {
            RandomStream rng = StreamFor(trial.name, StreamPurpose::kSampling);
            DoNotOptimize(made->Estimate(trial.data.problem, rng));
          }};
}

std::vector<BenchmarkCase> AllBenchmarkCases() {
  std::vector<BenchmarkCase> cases;
  for (const auto& group :
       {StageCases(), EstimatorCases(), CalibratedCases(), OpenCvCases(), PoseLibCases(), TrialCases()}) {
    cases.insert(cases.end(), group.begin(), group.end());
  }
  return cases;
}

}  // namespace rcme
