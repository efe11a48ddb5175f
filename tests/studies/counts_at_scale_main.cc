// How long does it take, and how much memory and disk, to merge the counts of so many trials that nobody here
// can compute them? The counts of some trials of a study are added to themselves again and again, which costs
// the merge what as many different trials would, but for the cells of medians: those of a few thousand
// different trials. Writes the parts, merges them, and prints what that took.
//
//   rcme_counts_at_scale STUDY FOLDER [trials in all, 1e8] [parts, 64]
#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "experiments/statistics/merge_counts.h"
#include "experiments/statistics/run_counts.h"
#include "experiments/statistics/summarize_counts.h"
#include "experiments/run/store/new_result_file.h"
#include "experiments/run/store/result_store.h"
#include "experiments/study/study_file.h"
#include "experiments/trial/trial.h"

namespace rcme {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint32_t kNumComputed = 250;  // of each condition

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// The counts of `num_trials` trials, of which `computed` are known, by doubling.
SummaryCell Repeated(const SummaryCell& computed, size_t num_estimators, std::int64_t num_times) {
  SummaryCell sum(num_estimators), power = computed;
  for (; num_times > 0; num_times /= 2) {
    if (num_times % 2 == 1) sum.Merge(power);
    power.Merge(SummaryCell(power));
  }
  return sum;
}

void WritePart(const RunDescription& run, const std::vector<ConditionCounts>& computed, const Shard& shard,
               const std::string& path) {
  RunDescription described = run;
  described.shard = shard.Text();
  RunCounts counts(described);
  std::set<std::uint32_t> all;
  for (std::uint32_t c = 0; c < counts.conditions.size(); ++c) {
    const auto num_trials = static_cast<std::uint32_t>(run.conditions[c].num_trials);
    const std::uint32_t num = ShardTrials(shard, c, 1).NumBefore(num_trials);
    counts.conditions[c].cell = Repeated(computed[c].cell, run.estimators.size(), num / kNumComputed);
    counts.conditions[c].places[shard.Text()] = Places::First(num / kNumComputed * kNumComputed);
    counts.conditions[c].kept = computed[c].kept;
    all.insert(c);
  }
  NewResultFile file(path, described);
  WriteCounts(counts, all, &file.file());
  file.Finish(described);
}

int Main(const std::string& study_path, const std::string& folder, double num_trials, int num_parts) {
  Study study = LoadStudy(study_path);
  const auto num_conditions = static_cast<double>(MakePlan(study).conditions.size());
  // As many in every part, for what is known is repeated whole.
  const double per_part = num_trials / num_conditions / num_parts;
  study.trials = static_cast<int>(std::ceil(per_part / kNumComputed) * kNumComputed * num_parts);
  const StudyPlan plan = MakePlan(study);
  RunDescription run = Describe(plan);
  run.keeps_counts = true;
  run.origin = ThisProgram();
  std::vector<ConditionCounts> computed;
  for (const Condition& condition : plan.conditions) {
    computed.emplace_back(plan.estimators.size());
    for (std::uint32_t trial = 0; trial < kNumComputed; ++trial) {
      const TrialResult result = RunTrial(plan, condition, trial);
      computed.back().cell.Add(result.problem, result.records, study.failure);
      computed.back().kept.Add({result.problem, result.records, 0}, study.failure);
    }
  }
  std::vector<std::string> parts;
  std::uintmax_t size = 0;
  for (int number = 1; number <= num_parts; ++number) {
    parts.push_back(fmt::format("{}/part_{}.sqlite", folder, number));
    WritePart(run, computed, {static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(num_parts)},
              parts.back());
    size += std::filesystem::file_size(parts.back());
  }
  const std::string merged = folder + "/merged.sqlite";
  Clock::time_point start = Clock::now();
  const MergeReport report = MergeCounts(parts, merged, false, {});
  const double merge_seconds = SecondsSince(start);
  start = Clock::now();
  const Summary summary = SummarizeCounts(OpenCounts(merged), false);
  const double summary_seconds = SecondsSince(start);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  fmt::print(
      "{} conditions, {} estimators, {} trials in {} parts of {:.2f} MB: merged in {:.2f} s ({:.1f} ms a "
      "part), "
      "{:.2f} MB, {} trials missing; summarized in {:.2f} s, {} rows; {:.0f} MB of memory at most\n",
      plan.conditions.size(), plan.estimators.size(), report.num_trials, num_parts,
      1e-6 * static_cast<double>(size) / num_parts, merge_seconds, 1e3 * merge_seconds / num_parts,
      1e-6 * static_cast<double>(std::filesystem::file_size(merged)), report.num_missing, summary_seconds,
      summary.rows.size(), 1e-3 * static_cast<double>(usage.ru_maxrss));
  return report.num_missing == 0 ? 0 : 1;
}

}  // namespace
}  // namespace rcme

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  return rcme::Main(argv[1], argv[2], argc > 3 ? std::atof(argv[3]) : 1e8,
                    argc > 4 ? std::atoi(argv[4]) : 64);
}
