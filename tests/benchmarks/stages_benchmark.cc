// Microseconds of each stage of one trial: n = 500 matches, 20 % outliers, sigma 0.5 px, N = 200 hypotheses.
//   cmake --build --preset benchmarks && build/release/bin/rcme_benchmark
// Absolute times belong to the machine; compare rows of one run.

#include <benchmark/benchmark.h>

#include <opencv2/calib3d.hpp>

#include "estimator/estimator_registry.h"
#include "estimator/reference_search.h"
#include "estimator/refinement/reprojection_mle.h"
#include "estimator/sample_consistency.h"
#include "experiments/data_source.h"

namespace rcme {
namespace {

constexpr int kNumHypotheses = 200;

const DataSource& Source() {
  static const DataSources made = MakeDataSources({{"scene", "uniform_volume"}, {"outlier_ratio", "0.2"}});
  return *made.sources[0].second;
}

const TrialData& Data() {
  static const TrialData data = Source().Make({1, 0, 0, 0});
  return data;
}

std::vector<Sample> Samples() {
  RandomStream rng = StreamFor({1, 0, 0, 0}, StreamPurpose::kSampling);
  std::vector<Sample> samples;
  for (int j = 0; j < kNumHypotheses; ++j) samples.push_back(DrawSample(500, rng));
  return samples;
}

std::vector<Hypothesis> Hypotheses() {
  std::vector<Hypothesis> hypotheses;
  for (const Sample& sample : Samples()) {
    hypotheses.push_back(InstantiateModel(Data().problem, sample).value());
    PropagateCovariance(Data().problem, &hypotheses.back());
  }
  return hypotheses;
}

void BM_SceneAndNoise(benchmark::State& state) {
  std::uint32_t trial = 0;
  for (auto _ : state) benchmark::DoNotOptimize(Source().Make({1, 0, trial++, 0}));
}

void BM_Sampling200(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(Samples());
}

void BM_InstantiateModel200(benchmark::State& state) {
  const std::vector<Sample> samples = Samples();
  for (auto _ : state) {
    for (const Sample& sample : samples) benchmark::DoNotOptimize(InstantiateModel(Data().problem, sample));
  }
}

void BM_PropagateCovariance200(benchmark::State& state) {
  std::vector<Hypothesis> hypotheses = Hypotheses();
  for (auto _ : state) {
    for (Hypothesis& hypothesis : hypotheses) PropagateCovariance(Data().problem, &hypothesis);
    benchmark::ClobberMemory();
  }
}

void BM_JointSampleTest200(benchmark::State& state) {
  const std::vector<Hypothesis> hypotheses = Hypotheses();
  for (auto _ : state) {
    for (const Hypothesis& hypothesis : hypotheses)
      benchmark::DoNotOptimize(JointSampleStatistic(hypothesis));
  }
}

template <typename PointTest>
void BM_ScoreOneHypothesis(benchmark::State& state) {
  Hypothesis hypothesis = Hypotheses()[0];
  const PointTest test = MakePointTest<PointTest>(Data().problem, &hypothesis).value();
  const Thresholds thresholds = Thresholds::For(Data().problem, {}, PointTest::kDegreesOfFreedom);
  for (auto _ : state) benchmark::DoNotOptimize(ScoreInliers(Data().problem, test, thresholds));
  state.counters["ns_per_match"] =
      benchmark::Counter(500e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void BM_RefineByReprojection(benchmark::State& state) {
  std::vector<int> inliers;
  for (size_t i = 0; i < Data().problem.matches.size(); ++i) {
    if (Data().truth.is_inlier_true[i]) inliers.push_back(static_cast<int>(i));
  }
  Vector5d offset = Vector5d::Constant(0.01);
  const RelativePose start = Retract(*Data().truth.cam2_from_cam1_true, offset);
  for (auto _ : state) {
    benchmark::DoNotOptimize(RefineByReprojection(Data().problem, inliers, start, Loss::kSquared));
  }
}

void BM_WholeEstimate(benchmark::State& state, const std::string& name, Reading reading) {
  RansacOptions options;
  options.reading = reading;
  const auto estimator = FindEstimator(name).make(options);
  std::uint32_t trial = 0;
  for (auto _ : state) {
    state.PauseTiming();
    const TrialData data = Source().Make({1, 0, trial, 0});
    RandomStream rng = StreamFor({1, 0, trial++, 0}, StreamPurpose::kSampling);
    state.ResumeTiming();
    benchmark::DoNotOptimize(estimator->Estimate(data.problem, rng));
  }
}

void BM_OpenCvFundamentalRansac200(benchmark::State& state) {
  cv::setNumThreads(1);
  std::uint32_t trial = 0;
  for (auto _ : state) {
    state.PauseTiming();
    const TrialData data = Source().Make({1, 0, trial++, 0});
    std::vector<cv::Point2d> x1, x2;
    for (const Correspondence& match : data.problem.matches) {
      x1.emplace_back(match.x1_px.x(), match.x1_px.y());
      x2.emplace_back(match.x2_px.x(), match.x2_px.y());
    }
    state.ResumeTiming();
    benchmark::DoNotOptimize(cv::findFundamentalMat(x1, x2, cv::FM_RANSAC, 1.0, 0.999999, 200));
  }
}

constexpr auto kMicroseconds = benchmark::kMicrosecond;
BENCHMARK(BM_SceneAndNoise)->Unit(kMicroseconds);
BENCHMARK(BM_Sampling200)->Unit(kMicroseconds);
BENCHMARK(BM_InstantiateModel200)->Unit(kMicroseconds);
BENCHMARK(BM_PropagateCovariance200)->Unit(kMicroseconds);
BENCHMARK(BM_JointSampleTest200)->Unit(kMicroseconds);
BENCHMARK(BM_ScoreOneHypothesis<KnownPoseTest>)->Unit(kMicroseconds);
BENCHMARK(BM_ScoreOneHypothesis<AsPrintedTest>)->Unit(kMicroseconds);
BENCHMARK(BM_ScoreOneHypothesis<RankAwareTest>)->Unit(kMicroseconds);
BENCHMARK(BM_RefineByReprojection)->Unit(kMicroseconds);
BENCHMARK_CAPTURE(BM_WholeEstimate, standard, "standard", Reading::kAsPrinted)->Unit(kMicroseconds);
BENCHMARK_CAPTURE(BM_WholeEstimate, prcme_as_printed, "prcme", Reading::kAsPrinted)->Unit(kMicroseconds);
BENCHMARK_CAPTURE(BM_WholeEstimate, rcme_as_printed, "rcme", Reading::kAsPrinted)->Unit(kMicroseconds);
BENCHMARK_CAPTURE(BM_WholeEstimate, rcme_rank_aware, "rcme", Reading::kRankAware)->Unit(kMicroseconds);
BENCHMARK(BM_OpenCvFundamentalRansac200)->Unit(kMicroseconds);

}  // namespace
}  // namespace rcme
