// rcme_calibrated whole, at 20 and at 50 % wrong matches, and its stages one after the other, each from what
// the one before it gives.
#include <benchmark/benchmark.h>

#include <cmath>
#include <map>
#include <memory>

#include "estimator/calibrated/candidates.h"
#include "estimator/calibrated/explain_matches.h"
#include "estimator/calibrated/mode_covariance.h"
#include "estimator/calibrated/weigh_modes.h"
#include "estimator/estimators/rcme_calibrated.h"
#include "stats/constants.h"
#include "tests/benchmarks/benchmark_cases.h"

namespace rcme {
namespace {

using benchmark::DoNotOptimize;

// What every stage of one trial takes.
struct Stages {
  explicit Stages(const BenchmarkTrial& trial)
      : score_matches(trial.blocks),
        prior{2.0 * trial.data.problem.sigma_px /
                  std::hypot(trial.data.problem.camera2.width, trial.data.problem.camera2.height),
              true} {
    RandomStream rng = StreamFor(trial.name, StreamPurpose::kSampling);
    search = SearchHypotheses(trial.blocks, score_matches, options, rng);
    found = FindModes(trial.blocks, prior, search.candidates, static_cast<size_t>(options.num_modes));
    modes = ExplainMatches(trial.data.problem, trial.blocks, prior, options, found);
  }
  CalibratedOptions options;
  ScoreMatches score_matches;
  MixturePrior prior;
  HypothesisSearch search;
  std::vector<Mode> found;
  std::vector<ExplainedMode> modes;
};

const Stages& FindStages(const BenchmarkTrial& trial) {
  static std::map<std::uint32_t, Stages> known;  // by trial
  return known.try_emplace(trial.name.trial, trial).first->second;
}

void Search(const BenchmarkTrial& trial) {
  const Stages& stages = FindStages(trial);
  RandomStream rng = StreamFor(trial.name, StreamPurpose::kSampling);
  DoNotOptimize(SearchHypotheses(trial.blocks, stages.score_matches, stages.options, rng));
}
void Modes(const BenchmarkTrial& trial) {
  const Stages& stages = FindStages(trial);
  DoNotOptimize(FindModes(trial.blocks, stages.prior, stages.search.candidates,
                          static_cast<size_t>(stages.options.num_modes)));
}
void Explanations(const BenchmarkTrial& trial) {
  const Stages& stages = FindStages(trial);
  DoNotOptimize(ExplainMatches(trial.data.problem, trial.blocks, stages.prior, stages.options, stages.found));
}
void Weights(const BenchmarkTrial& trial) {
  const Stages& stages = FindStages(trial);
  const MotionBounds bounds{kRadPerDeg * stages.options.max_rotation_error_deg,
                            kRadPerDeg * stages.options.max_direction_error_deg};
  DoNotOptimize(WeighModes(stages.modes, bounds, stages.prior, stages.options));
}
void ComputeSandwich(const BenchmarkTrial& trial) {
  const ExplainedMode& mode = FindStages(trial).modes.front();
  const Matrix5d inverse = InverseOfObserved(trial.blocks, mode.mode);
  DoNotOptimize(SandwichCovariance(mode.mode, mode.explanation, inverse));
}
void MixtureSums200(const BenchmarkTrial& trial) {
  const Mode& mode = FindStages(trial).modes.front().mode;
  for (int i = 0; i < kNumHypotheses; ++i)
    DoNotOptimize(SumMixture(trial.blocks, mode.used, mode.pose, mode.mixture));
}

BenchmarkCase HalfWrongCase(const std::string& name, const CalibratedOptions& options) {
  const std::shared_ptr<const MotionEstimator> made = MakeRcmeCalibrated(options);
  return {"estimator", name, [made](const BenchmarkTrial& trial) {
            static std::map<std::uint32_t, TrialData> known;  // by trial
            const auto found = known.find(trial.name.trial);
            const TrialData& data = found != known.end() ? found->second
                                                         : known[trial.name.trial] = MakeBenchmarkData(
                                                               kNumMatches, trial.name.trial, "0.5");
            RandomStream rng = StreamFor(trial.name, StreamPurpose::kSampling);
            DoNotOptimize(made->Estimate(data.problem, rng));
          }};
}

}  // namespace

BenchmarkCase CalibratedCase(const std::string& name, const CalibratedOptions& options) {
  const std::shared_ptr<const MotionEstimator> made = MakeRcmeCalibrated(options);
  return {"estimator", name, [made](const BenchmarkTrial& trial) {
            RandomStream rng = StreamFor(trial.name, StreamPurpose::kSampling);
            DoNotOptimize(made->Estimate(trial.data.problem, rng));
          }};
}

std::vector<BenchmarkCase> CalibratedCases() {
  CalibratedOptions robust;
  robust.covariance = CovarianceKind::kRobust;
  const std::string stage = "stage";
  return {CalibratedCase("rcme_calibrated"),
          CalibratedCase("rcme_calibrated_robust", robust),
          HalfWrongCase("rcme_calibrated_half_wrong", {}),
          HalfWrongCase("rcme_calibrated_half_wrong_robust", robust),
          {stage, "calibrated_search", Search},
          {stage, "calibrated_modes", Modes},
          {stage, "calibrated_explanations", Explanations},
          {stage, "calibrated_weights", Weights},
          {stage, "calibrated_covariance", ComputeSandwich},
          {stage, "calibrated_mixture_sums", MixtureSums200}};
}

}  // namespace rcme
