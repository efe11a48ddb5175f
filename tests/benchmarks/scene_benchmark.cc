// What a scene is made of: random numbers (against the standard library's), points, observations; n = 500.
//   build/release/bin/rcme_benchmark --benchmark_filter='Uniform|Normal|Stream|Scene|Observe'

#include <benchmark/benchmark.h>

#include <random>

#include "simulator/noise/noise_laws.h"
#include "simulator/observe.h"
#include "simulator/scene_generator.h"

namespace rcme {
namespace {

constexpr size_t kNumValues = 2000;  // the noise of 500 matches

void CountValues(benchmark::State& state) {
  state.counters["ns_per_value"] = benchmark::Counter(
      kNumValues * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

template <void (RandomStream::*kFill)(std::span<double>)>
void BM_Fill(benchmark::State& state) {
  RandomStream rng({1, 0, 0, 0});
  std::vector<double> values(kNumValues);
  for (auto _ : state) {
    (rng.*kFill)(values);
    benchmark::ClobberMemory();
  }
  CountValues(state);
}

template <double (RandomStream::*kDraw)()>
void BM_OneByOne(benchmark::State& state) {
  RandomStream rng({1, 0, 0, 0});
  std::vector<double> values(kNumValues);
  for (auto _ : state) {
    for (double& value : values) value = (rng.*kDraw)();
    benchmark::ClobberMemory();
  }
  CountValues(state);
}

template <typename Distribution>
void BM_StandardLibrary(benchmark::State& state) {
  std::mt19937_64 rng(1);
  Distribution distribution;
  std::vector<double> values(kNumValues);
  for (auto _ : state) {
    for (double& value : values) value = distribution(rng);
    benchmark::ClobberMemory();
  }
  CountValues(state);
}

void BM_NewStreamAndOneWord(benchmark::State& state) {
  for (std::uint32_t trial = 0; auto _ : state) {
    RandomStream rng({1, 0, trial++, 0});
    benchmark::DoNotOptimize(rng.Next32());
  }
}

Scene DrawScene(std::uint32_t trial) {
  static const SceneGenerator model("uniform_volume");
  RandomStream rng({1, 0, trial, 1});
  return model.Generate(rng);
}

void BM_DrawScene(benchmark::State& state) {
  for (std::uint32_t trial = 0; auto _ : state) benchmark::DoNotOptimize(DrawScene(trial++));
}

void BM_Observe(benchmark::State& state) {
  const Scene scene = DrawScene(0);
  for (std::uint32_t trial = 0; auto _ : state) {
    RandomStream noise_rng({1, 0, trial, 2}), outlier_rng({1, 0, trial++, 3});
    benchmark::DoNotOptimize(
        Observe(scene, *MakeGaussianNoise(0.5), OutlierModel(0.2), noise_rng, outlier_rng));
  }
}

BENCHMARK(BM_Fill<&RandomStream::FillUniform>)->Name("BM_FillUniform");
BENCHMARK(BM_OneByOne<&RandomStream::Uniform>)->Name("BM_Uniform");
BENCHMARK(BM_StandardLibrary<std::uniform_real_distribution<>>)->Name("BM_StandardUniform");
BENCHMARK(BM_Fill<&RandomStream::FillNormal>)->Name("BM_FillNormal");
BENCHMARK(BM_OneByOne<&RandomStream::Normal>)->Name("BM_Normal");
BENCHMARK(BM_StandardLibrary<std::normal_distribution<>>)->Name("BM_StandardNormal");
BENCHMARK(BM_NewStreamAndOneWord);
BENCHMARK(BM_DrawScene)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_Observe)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace rcme
