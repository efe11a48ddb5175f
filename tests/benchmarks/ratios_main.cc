// All cases (benchmark_cases.h), growing problems and studies, in interleaved rounds; writes their times, the
// ratios between them, percentages of the machine's peak and exponents, each a median over rounds with its
// interval, as JSON.
//   build/release/bin/rcme_ratios --out benchmarks.json          (scripts/benchmark does it, draws and
//   compares)

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <stdlib.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <thread>

#include "experiments/core/files/file_output.h"
#include "experiments/study/study_file.h"
#include "tests/benchmarks/benchmark_cases.h"
#include "tests/benchmarks/engine_fixture.h"
#include "tests/benchmarks/fma_peak.h"
#include "tests/benchmarks/processor.h"
#include "tests/benchmarks/rounds.h"

namespace rcme {
namespace {

using nlohmann::ordered_json;
using Times = std::map<std::string, PerRound>;

// How much is measured.
struct Extent {
  int num_rounds = 61;
  double least_seconds = 0.002;
  int num_trials = kNumBenchmarkTrials;
  std::vector<int> num_matches = {100, 200, 500, 1000, 2000, 5000};
  std::vector<int> num_iterations = {50, 100, 200, 500, 1000};
  std::vector<int> num_study_trials = {300, 1000, 3000};
  int num_rcme_trials = 1500;  // of the study on one thread and on two
};

Extent Quick() {
  Extent extent;
  extent.num_rounds = 9;
  return extent;
}

// For the test of what is written: the numbers mean nothing.
Extent Tiny() { return {6, 1e-6, 1, {100, 200}, {8, 16}, {10, 20}, 4}; }

// One run of a case is one call per trial.
Task MakeTask(const std::string& name, const BenchmarkCase& timed, const std::vector<BenchmarkTrial>& trials,
              int num_trials) {
  const auto run = [&trials, num_trials, call = timed.call] {
    for (int i = 0; i < num_trials; ++i) call(trials[static_cast<size_t>(i)]);
  };
  return {name, run, static_cast<double>(num_trials)};
}

std::string SizedName(const std::string& series, int size) { return fmt::format("{}/{}", series, size); }

// pRCME as printed: it scores every hypothesis.
BenchmarkCase PrcmeCase(int num_iterations) {
  RansacOptions options;
  options.num_iterations = num_iterations;
  return EstimatorCase("prcme", "prcme", options);
}

const BenchmarkCase& FindCase(const std::vector<BenchmarkCase>& cases, const std::string& name) {
  return *std::find_if(cases.begin(), cases.end(),
                       [&](const BenchmarkCase& timed) { return timed.name == name; });
}

void AddGrowingProblems(const Extent& extent, const std::vector<BenchmarkCase>& cases,
                        std::vector<Task>* tasks) {
  static std::map<int, std::vector<BenchmarkTrial>> trials;  // as long as the tasks
  const int num_trials = std::min(extent.num_trials, 4);
  for (const int n : extent.num_matches) {
    trials[n] = MakeBenchmarkTrials(n, num_trials);
    tasks->push_back(MakeTask(SizedName("n", n), PrcmeCase(kNumHypotheses), trials[n], num_trials));
    tasks->push_back(
        MakeTask(SizedName("n_scoring", n), FindCase(cases, "score_as_printed/fast"), trials[n], num_trials));
    tasks->push_back(
        MakeTask(SizedName("n_calibrated", n), CalibratedCase("rcme_calibrated"), trials[n], num_trials));
  }
  for (const int iterations : extent.num_iterations) {
    tasks->push_back(
        MakeTask(SizedName("iterations", iterations), PrcmeCase(iterations), BenchmarkTrials(), num_trials));
  }
}

void AddStudy(const std::string& name, const StudyPlan& plan, int num_threads, std::vector<Task>* tasks) {
  const auto shared = std::make_shared<const StudyPlan>(plan);
  tasks->push_back(
      {name, [shared, num_threads] { RunToScratchFile(*shared, num_threads); }, 1.0, Task::Clock::kWall});
}

// A study of rcme as printed on the problem of all the cases.
StudyPlan RcmePlan(int trials) {
  return MakePlan(ParseStudy(
      fmt::format("name: throughput\nseed: 1\ntrials: {}\ndata: {{scene: uniform_volume, num_matches: 500, "
                  "outlier_ratio: 0.2, sigma_px: 0.5, severity: skipped}}\nestimators:\n  - {{name: rcme}}\n",
                  trials),
      "throughput"));
}

void AddStudies(const Extent& extent, std::vector<Task>* tasks) {
  for (const int trials : extent.num_study_trials) {
    AddStudy(SizedName("trials", trials), RcmePlan(trials), 0, tasks);
  }
  for (const int threads : {1, 2}) {
    AddStudy(SizedName("threads", threads), RcmePlan(extent.num_rcme_trials), threads, tasks);
  }
}

std::vector<Task> MakeTasks(const Extent& extent, const std::vector<BenchmarkCase>& cases) {
  std::vector<Task> tasks;
  for (const BenchmarkCase& timed : cases)
    tasks.push_back(MakeTask(timed.name, timed, BenchmarkTrials(), extent.num_trials));
  AddGrowingProblems(extent, cases, &tasks);
  AddStudies(extent, &tasks);
  tasks.push_back(
      {"fma_peak", [] { benchmark::DoNotOptimize(RunFusedMultiplyAdds()); }, 1.0 * kFmaChains * kFmaSteps});
  return tasks;
}

// Arithmetic instructions (fused multiply-add, addition, multiplication: one each) per vector of matches,
// counted in the sources of estimator/kernels. Left out: loads, divisions, comparisons, minima and maxima,
// masks, compression, and what depends on the model alone.
//
// Both: EvaluateConstraint 12 (four gradients of 2, `last` 2, g 2), n2 = Dot4 4, g^2 1.
//
// ScanRankAware: the above 17, EvaluateVariance 41 (6 products of coordinates, 30 + 5 by Horner), n2 +
// variance 1, limit * total 1.
constexpr int kRankAwareOperations = 17 + 41 + 1 + 1;
// ScanAsPrinted: the above 17; a = H j 8; for each of five axes EvaluateConstraint 12, AddOuterProduct 10, a
// 4, D 1; Q = L diag(d) L' 16 (l10, l20, l30: 3; d1 1; s21, s31: 2; l21, l31: 2; d2 2; s32 2; l32 1; d3 3);
// two times `solve` 6; iy and ib 8; jQj 4, rest 5, e 5, p 2; squared_distance 1, numerator 1, determinant 12,
// IsWithin 1.
constexpr int kPrintedOperations =
    17 + 8 + 5 * (12 + 10 + 4 + 1) + 16 + 2 * 6 + 8 + (4 + 5 + 5 + 2) + (1 + 1 + 12 + 1);

// SumMixture: EvaluateConstraint 12, Dot4 4; EvaluateDepths 37 (rays 4, R ray1 9, five Dot 15, `both` 1,
// along 4, square 4), Least 4; EvaluateMixture 29; u 1; EvaluateSlopes 14 and 8 for each of five derivatives;
// 10 of the sums beside the five of the gradient and the 5 + 15 of the Hessian.
constexpr int kMixtureOperations = 12 + 4 + 37 + 4 + 29 + 1 + 14 + 5 * 8 + 10 + 5 + 20;

// Share of the peak that a scan of all hypotheses reaches.
PerRound ShareOfPeak(const PerRound& scan_seconds, int operations, const PerRound& seconds_per_fma) {
  const int num_vectors = BenchmarkTrials()[0].blocks.num_blocks() * kBlockSize / LanesPerVector();
  const double num_operations = 1.0 * kNumHypotheses * num_vectors * operations;
  PerRound share = Quotient(seconds_per_fma, scan_seconds);
  for (double& value : share) value *= num_operations;
  return share;
}

std::vector<PerRound> ListSeries(const Times& times, const std::string& series,
                                 const std::vector<int>& sizes) {
  std::vector<PerRound> seconds;
  for (const int size : sizes) seconds.push_back(times.at(SizedName(series, size)));
  return seconds;
}

// One number of `ratios`.
struct Ratio {
  std::string name, meaning;
  PerRound values;
};

void AddPeerRatios(const Times& times, std::vector<Ratio>* ratios) {
  const auto speedup = [&](const std::string& name, const std::string& peer, const std::string& ours,
                           const std::string& meaning) {
    if (times.contains(peer)) ratios->push_back({name, meaning, Quotient(times.at(peer), times.at(ours))});
  };
  const std::string rcme = "rcme_as_printed/fast", per_rcme = " / time of rcme (as printed, options default)";
  const std::string ransac_200 = "time of findFundamentalMat(FM_RANSAC, 1 px, 0.999999, 200)";
  speedup("rcme_vs_opencv_ransac_200", "opencv_ransac_200", rcme, ransac_200 + per_rcme);
  speedup("rcme_vs_opencv_usac_magsac", "opencv_usac_magsac", rcme,
          "time of findFundamentalMat(USAC_MAGSAC)" + per_rcme);
  speedup("rcme_vs_opencv_usac_accurate", "opencv_usac_accurate", rcme,
          "time of findFundamentalMat(USAC_ACCURATE)" + per_rcme);
  speedup("rcme_vs_poselib_relative_pose", "poselib_relative_pose", rcme,
          "time of PoseLib's estimate_relative_pose" + per_rcme);
  for (const std::string peer : {"opencv_ransac_200", "opencv_usac_magsac", "poselib_relative_pose"})
    speedup("rcme_calibrated_vs_" + peer, peer, "rcme_calibrated",
            "time of " + peer + " / time of rcme_calibrated (options default)");
  speedup("rcme_vs_reference", "rcme_as_printed/reference", rcme,
          "time of rcme with implementation reference, refinement_error reprojection" + per_rcme);
  speedup("standard_vs_opencv_ransac_200", "opencv_ransac_200", "standard/fast",
          ransac_200 + " / time of standard (options default)");
}

void AddStudyRatios(const Extent& extent, const Times& times, std::vector<Ratio>* ratios) {
  ratios->push_back({"trial_vs_rcme_call",
                     "time of a trial (data made, rcme, score) / time of its call of rcme",
                     Quotient(times.at("whole_trial"), times.at("rcme_as_printed/fast"))});
  ratios->push_back(
      {"two_threads_vs_one",
       fmt::format("trials per second of a study of {} trials with rcme, result file included, on two "
                   "threads / on one; wall time",
                   extent.num_rcme_trials),
       Quotient(times.at("threads/1"), times.at("threads/2"))});
}

void AddShares(const Times& times, std::vector<Ratio>* ratios) {
  const auto meaning = [](const std::string& scan, int operations) {
    return fmt::format(
        "arithmetic vector instructions per second of {} ({} per vector of matches) / measured peak of "
        "independent fused multiply-adds",
        scan, operations);
  };
  ratios->push_back({"printed_score_fma_peak", meaning("ScanAsPrinted", kPrintedOperations),
                     ShareOfPeak(times.at("scan_as_printed"), kPrintedOperations, times.at("fma_peak"))});
  ratios->push_back({"rank_aware_score_fma_peak", meaning("ScanRankAware", kRankAwareOperations),
                     ShareOfPeak(times.at("scan_rank_aware"), kRankAwareOperations, times.at("fma_peak"))});
  ratios->push_back(
      {"mixture_sums_fma_peak", meaning("SumMixture", kMixtureOperations),
       ShareOfPeak(times.at("calibrated_mixture_sums"), kMixtureOperations, times.at("fma_peak"))});
}

void AddExponents(const Extent& extent, const Times& times, std::vector<Ratio>* ratios) {
  const auto add = [&](const std::string& series, const std::vector<int>& sizes, const std::string& meaning) {
    ratios->push_back({"exponent_" + series,
                       fmt::format("slope of log time over log size, sizes {} to {}: {}", sizes.front(),
                                   sizes.back(), meaning),
                       Exponent(sizes, ListSeries(times, series, sizes))});
  };
  add("n", extent.num_matches, "whole call of prcme (as printed, N = 200) over n");
  add("n_scoring", extent.num_matches, "scoring of 200 hypotheses as printed over n");
  add("n_calibrated", extent.num_matches, "whole call of rcme_calibrated over n");
  add("iterations", extent.num_iterations, "whole call of prcme (as printed, n = 500) over N");
  add("trials", extent.num_study_trials,
      "wall time of a study with rcme, on all cores, over its number of trials");
}

std::vector<Ratio> MakeRatios(const Extent& extent, const Times& times) {
  std::vector<Ratio> ratios;
  AddPeerRatios(times, &ratios);
  AddStudyRatios(extent, times, &ratios);
  AddShares(times, &ratios);
  AddExponents(extent, times, &ratios);
  return ratios;
}

ordered_json RenderBounds(const MeasuredQuantile& median) {
  return {{"lower", median.interval.lower}, {"upper", median.interval.upper}};
}

ordered_json Described(const PerRound& values, double unit = 1.0) {
  PerRound scaled = values;
  for (double& value : scaled) value *= unit;
  const MeasuredQuantile median = MeasureMedian(scaled);
  ordered_json described = RenderBounds(median);
  described["median"] = median.value;
  return described;
}

void WriteRatios(const std::vector<Ratio>& ratios, ordered_json* out) {
  for (const Ratio& ratio : ratios) {
    const MeasuredQuantile median = MeasureMedian(ratio.values);
    (*out)["ratios"][ratio.name] = median.value;
    (*out)["intervals"][ratio.name] = RenderBounds(median);
    (*out)["meanings"][ratio.name] = ratio.meaning;
  }
}

// Time of every case; of a stage that exists twice also the reference's over the fast one's.
void WriteCases(const std::vector<BenchmarkCase>& cases, const Times& times, ordered_json* out) {
  (*out)["cases"] = ordered_json::array();
  for (const BenchmarkCase& timed : cases) {
    ordered_json row = {{"group", timed.group}, {"name", timed.name}};
    row["microseconds"] = Described(times.at(timed.name), 1e6);
    (*out)["cases"].push_back(row);
    const size_t slash = timed.name.find("/reference");
    if (slash == std::string::npos) continue;
    const std::string stage = timed.name.substr(0, slash);
    (*out)["speedups"][stage] = Described(Quotient(times.at(timed.name), times.at(stage + "/fast")));
  }
}

void WriteSeries(const Extent& extent, const Times& times, ordered_json* out) {
  for (const auto& [series, sizes] : {std::pair{"n", extent.num_matches},
                                      {"n_scoring", extent.num_matches},
                                      {"n_calibrated", extent.num_matches},
                                      {"iterations", extent.num_iterations},
                                      {"trials", extent.num_study_trials}}) {
    for (const int size : sizes) {
      ordered_json point = Described(times.at(SizedName(series, size)), 1e6);
      point["size"] = size;
      (*out)["series"][series].push_back(point);
    }
  }
}

double LoadAverage() {
  double load = 0.0;
  getloadavg(&load, 1);
  return load;
}

ordered_json DescribeRun(const Extent& extent, const Times& times, const std::string& extent_name) {
  PerRound rate = times.at("fma_peak");
  for (double& value : rate) value = LanesPerVector() / value * 1e-9;
  return {
      {"extent", extent_name},
      {"rounds", extent.num_rounds},
      {"clock", "CPU time of the thread; studies: wall time"},
      {"problem", "uniform_volume, n = 500, 20 % outliers, sigma 0.5 px, N = 200"},
      {"interval", "median over rounds, order statistics, 95 %"},
      {"processor", FindProcessor()},
      {"instruction_set", InstructionSet()},
      {"cores", std::thread::hardware_concurrency()},
      {"peak_fma_lanes_per_ns", Described(rate)},
      {"poselib", times.contains("poselib_relative_pose")
                      ? "measured"
                      : "skipped: PoseLib was not found when this was built (it is not a Debian package)"}};
}

void Run(const Extent& extent, const std::string& extent_name, const std::string& path) {
  const double load_average = LoadAverage();
  const std::vector<BenchmarkCase> cases = AllBenchmarkCases();
  const Times times = MeasureRounds(MakeTasks(extent, cases), extent.num_rounds, extent.least_seconds);
  ordered_json out;
  out["run"] = DescribeRun(extent, times, extent_name);
  out["run"]["load_average_at_start"] = load_average;
  WriteRatios(MakeRatios(extent, times), &out);
  WriteCases(cases, times, &out);
  WriteSeries(extent, times, &out);
  WriteFileWhole(path, out.dump(1) + "\n");
}

int Main(int argc, char** argv) {
  CLI::App app{
      "Times of kernels, stages, estimators and studies in interleaved rounds, and ratios between them."};
  std::string path;
  bool is_quick = false, is_tiny = false;
  app.add_option("--out", path, "JSON file to write")->required();
  app.add_flag("--quick", is_quick, "fewer rounds: under a minute, wider intervals");
  app.add_flag("--tiny", is_tiny, "one trial and tiny studies: for the test of what is written");
  CLI11_PARSE(app, argc, argv);
  Run(is_tiny ? Tiny() : is_quick ? Quick() : Extent(), is_tiny ? "tiny" : is_quick ? "quick" : "full", path);
  return 0;
}

}  // namespace
}  // namespace rcme

int main(int argc, char** argv) {
  try {
    return rcme::Main(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "rcme_ratios: {}\n", error.what());
    return 1;
  }
}
