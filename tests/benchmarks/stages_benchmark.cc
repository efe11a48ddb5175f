// Microseconds of every case (benchmark_cases.h): kernels and stages of the estimator, fast and reference,
// whole estimators beside OpenCV's, a whole trial. n = 500 matches, 20 % outliers, sigma 0.5 px, N = 200
// hypotheses.
//   cmake --build --preset benchmarks && build/release/bin/rcme_benchmark --benchmark_filter=stage/score
// Absolute times belong to the machine; scripts/benchmark measures ratios.

#include <benchmark/benchmark.h>

#include "tests/benchmarks/benchmark_cases.h"

namespace rcme {
namespace {

void RunCase(benchmark::State& state, const BenchmarkCase& timed) {
  const std::vector<BenchmarkTrial>& trials = BenchmarkTrials();
  for (size_t trial = 0; auto _ : state) {
    timed.call(trials[trial]);
    trial = (trial + 1) % trials.size();
  }
}

[[maybe_unused]] const bool is_registered = [] {
  for (const BenchmarkCase& timed : AllBenchmarkCases()) {
    benchmark::RegisterBenchmark((timed.group + "/" + timed.name).c_str(), RunCase, timed)
        ->Unit(benchmark::kMicrosecond);
  }
  return true;
}();

}  // namespace
}  // namespace rcme
