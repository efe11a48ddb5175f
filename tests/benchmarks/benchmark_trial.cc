#include "tests/benchmarks/benchmark_trial.h"

#include <map>

#include "estimator/kernels/sampson_equations.h"
#include "experiments/data/make_data.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

StreamName MakeTrialName(std::uint32_t trial) { return {1, 0, trial, 0}; }

}  // namespace

TrialData MakeBenchmarkData(int num_matches, std::uint32_t trial, const std::string& outlier_ratio) {
  static std::map<std::pair<int, std::string>, std::shared_ptr<const DataSource>> sources;
  std::shared_ptr<const DataSource>& source = sources[{num_matches, outlier_ratio}];
  if (!source) {
    source = MakeDataSources({{"scene", "uniform_volume"},
                              {"num_matches", std::to_string(num_matches)},
                              {"outlier_ratio", outlier_ratio},
                              {"sigma_px", "0.5"}})
                 .sources[0]
                 .second;
  }
  return source->Make(MakeTrialName(trial));
}

BenchmarkTrial::BenchmarkTrial(int num_matches, std::uint32_t trial)
    : name(MakeTrialName(trial)), data(MakeBenchmarkData(num_matches, trial)), blocks(data.problem) {
  for (const Correspondence& match : data.problem.matches) {
    x1.emplace_back(static_cast<float>(match.x1_px.x()), static_cast<float>(match.x1_px.y()));
    x2.emplace_back(static_cast<float>(match.x2_px.x()), static_cast<float>(match.x2_px.y()));
  }
  MakeHypotheses(num_matches);
  MakeFivePointSamples();
  FindWinner();
  for (int i = 0; i < num_matches; ++i) {
    if (data.truth.is_inlier_true[static_cast<size_t>(i)]) inliers.push_back(i);
  }
  inlier_mask = MakeMask(inliers, blocks);
  start = Retract(*data.truth.cam2_from_cam1_true, Vector5d::Constant(0.01));
  refined = RefineBySampson(blocks, inlier_mask, start, Loss::kSquared);
}

void BenchmarkTrial::MakeHypotheses(int num_matches) {
  RandomStream rng = StreamFor(name, StreamPurpose::kSampling);
  for (int j = 0; j < kNumHypotheses; ++j) samples.push_back(DrawSample(8, num_matches, rng));
  for (const Sample& sample : samples) {
    hypotheses.push_back(InstantiateModel<EightPoint>(data.problem, {sample}).value());
    PropagateCovariance(data.problem, &hypotheses.back());
  }
  hypothesis_blocks.resize(samples.size() / kBlockSize);
  for (size_t b = 0; b < hypothesis_blocks.size(); ++b) {
    InstantiateModels(blocks, std::span<const Sample, kBlockSize>(&samples[b * kBlockSize], kBlockSize),
                      RequestedOutputs::kCovariance, &hypothesis_blocks[b]);
    for (int lane = 0; lane < kBlockSize; ++lane) models.emplace_back(hypothesis_blocks[b], lane);
  }
  for (const WhitenedModel& model : models) variances.emplace_back(model.dF);
}

void BenchmarkTrial::MakeFivePointSamples() {
  five_point_samples.resize(samples.size() / kBlockSize);
  five_rays.resize(samples.size());
  for (size_t j = 0; j < samples.size(); ++j) {
    FivePointSamples& block = five_point_samples[j / kBlockSize];
    const size_t lane = j % kBlockSize;
    for (size_t k = 0; k < FivePoint::kSampleSize; ++k) {
      const Correspondence& match = data.problem.matches[static_cast<size_t>(samples[j][k])];
      const Eigen::Vector3d ray1 = data.problem.camera1.Ray(match.x1_px);
      const Eigen::Vector3d ray2 = data.problem.camera2.Ray(match.x2_px);
      five_rays[j].first[k] = ray1;
      five_rays[j].second[k] = ray2;
      block.x1[k][lane] = ray1.x();
      block.y1[k][lane] = ray1.y();
      block.x2[k][lane] = ray2.x();
      block.y2[k][lane] = ray2.y();
    }
  }
}

void BenchmarkTrial::FindWinner() {
  const double threshold = ChiSquareQuantile(1, 0.95);
  InlierScan scan(blocks);
  int most = -1;
  for (size_t j = 0; j < samples.size(); ++j) {
    ScanKnownPose(blocks, models[j].F, threshold, &scan);
    if (scan.num_inliers <= most) continue;
    most = scan.num_inliers;
    winner = {samples[j]};
    support = scan.inliers;
  }
}

std::vector<BenchmarkTrial> MakeBenchmarkTrials(int num_matches, int num_trials) {
  std::vector<BenchmarkTrial> trials;
  trials.reserve(static_cast<size_t>(num_trials));
  for (int trial = 0; trial < num_trials; ++trial) {
    trials.emplace_back(num_matches, static_cast<std::uint32_t>(trial));
  }
  return trials;
}

const std::vector<BenchmarkTrial>& BenchmarkTrials() {
  static const std::vector<BenchmarkTrial> trials = MakeBenchmarkTrials(kNumMatches, kNumBenchmarkTrials);
  return trials;
}

}  // namespace rcme
