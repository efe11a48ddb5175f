// What is common to merging trials (merge_results.h) and counts: which parts belong together, and what is
// said of the merge.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "experiments/core/work/shard.h"
#include "experiments/run/store/result_file.h"

namespace rcme {

struct MergeOptions {
  // Parts of other instruction sets than the first one's are merged too.
  bool are_instruction_sets_mixed = false;
};

struct MergeReport {
  RunDescription run;            // of the whole
  std::int64_t num_trials = 0;   // held by the parts together
  std::int64_t num_twice = 0;    // read again from another part: they were equal
  std::int64_t num_missing = 0;  // of those asked for; 0 under a stopping rule, which alone knows
  std::uint32_t num_shards = 0;  // 0: the parts do not agree on it
  std::vector<std::uint32_t> missing_shards;  // ascending: lost, not whole, or not among the parts
  std::vector<std::string> unreadable;  // parts that could not be read, in words; their trials are missing
};

// "1-3,7/64" of a merge that lacks trials; empty if none is missing, or no shards are known.
std::string ShardsOfMerged(const MergeReport& report);

// "3/64" -> 64; the whole: 1. Throws Damage.
std::uint32_t ReadNumShards(const RunDescription& run);

// A part, open to be read, alone and without locks: its description is checked, its trials are not yet.
// Throws InputError.
std::unique_ptr<ResultFile> OpenPart(const std::string& path);

// The descriptions of the parts as one. What it makes does not depend on their order.
class PartDescriptions {
 public:
  explicit PartDescriptions(const MergeOptions& options) : options_(options) {}

  // Throws InputError if the part does not belong to those before, and says what differs.
  void Add(const ResultFile& part);

  bool IsEmpty() const { return first_path_.empty(); }
  std::int64_t num_trials() const { return num_trials_; }   // in all parts
  std::uint32_t num_shards() const { return num_shards_; }  // 0: the parts do not agree on it
  RunDescription Merged() const;

 private:
  void AddOrigin(const ResultFile& part);
  void AddAskedFor(const RunDescription& run);

  const MergeOptions options_;
  std::string first_path_, origin_path_;
  RunDescription merged_;
  std::int64_t num_trials_ = 0;
  std::uint32_t num_shards_ = 0;
  bool is_until_known_ = true;
};

// A part that cannot be read is an error, or where `unreadable` is given noted there and left aside.
PartDescriptions DescribeParts(const std::vector<std::string>& parts, const MergeOptions& options,
                               std::vector<std::string>* unreadable);

}  // namespace rcme
