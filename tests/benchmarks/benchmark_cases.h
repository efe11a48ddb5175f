// What is timed, named once for two programs: rcme_benchmark (Google Benchmark: one case after the other, for
// work on one of them) and rcme_ratios (all cases in turn, round after round, for ratios that last).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "estimator/calibrated/calibrated_options.h"
#include "estimator/ransac_options.h"
#include "tests/benchmarks/benchmark_trial.h"

namespace rcme {

// Names are "stage/fast" and "stage/reference" where a stage exists twice.
struct BenchmarkCase {
  std::string group;  // stage, estimator, peer, trial
  std::string name;
  std::function<void(const BenchmarkTrial&)> call;
};

// Every stage of a call, 200 hypotheses where it has to do with hypotheses; every estimator of the RANSAC
// family in both implementations; other people's estimators; a trial of a study.
std::vector<BenchmarkCase> AllBenchmarkCases();

// The call of an estimator with these options on one trial's matches.
BenchmarkCase EstimatorCase(const std::string& name, const std::string& estimator,
                            const RansacOptions& options);

// rcme_calibrated by its own stopping rule.
BenchmarkCase CalibratedCase(const std::string& name, const CalibratedOptions& options = {});
// The same, with half the matches wrong and with the robust covariance too, and its stages.
std::vector<BenchmarkCase> CalibratedCases();

// PoseLib's estimator where the library is installed, and nothing where it is not.
std::vector<BenchmarkCase> PoseLibCases();

}  // namespace rcme
