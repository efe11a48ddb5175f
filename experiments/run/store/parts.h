// Common to merging trials (merge_results.h) and counts: which parts belong together, and the report of a
// merge.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "experiments/core/work/shard.h"
#include "experiments/run/store/result_file.h"

namespace rcme {

struct MergeOptions {
  // Allows parts of several instruction sets.
  bool are_instruction_sets_mixed = false;
};

struct MergeReport {
  RunDescription run;           // of the whole
  std::int64_t num_trials = 0;  // held by the parts together
  std::int64_t num_twice = 0;   // found again in another part, and equal
  // Planned but not held. 0 under a stopping rule, because the number is not planned.
  std::int64_t num_missing = 0;
  std::uint32_t num_shards = 0;  // 0: the parts disagree
  // Ascending: shards with trials that are lost, not computed, or not among the parts.
  std::vector<std::uint32_t> missing_shards;
  // Messages about parts that could not be read; their trials are missing.
  std::vector<std::string> unreadable;
};

// Returns the complete shards of a merge that lacks trials, such as "1-3,7/64". Empty if no trial is missing
// or the shards are not known.
std::string ShardsOfMerged(const MergeReport& report);

// Opens a part for reading, without locks. Its description is checked, its trials are not yet. Throws
// InputError.
std::unique_ptr<ResultFile> OpenPart(const std::string& path);

// Combines the descriptions of parts. The result does not depend on their order.
class PartDescriptions {
 public:
  explicit PartDescriptions(const MergeOptions& options) : options_(options) {}

  // Throws InputError if the part does not belong to those added before; the message says what differs.
  // Throws Damage if its conditions cannot be those of its study.
  void Add(const ResultFile& part);

  bool IsEmpty() const { return first_path_.empty(); }
  std::int64_t num_trials() const { return num_trials_; }   // in all parts
  std::uint32_t num_shards() const { return num_shards_; }  // 0: the parts disagree
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

// Adds all parts. A part that cannot be read throws, or, if `unreadable` is given, is noted there and
// skipped.
PartDescriptions DescribeParts(const std::vector<std::string>& parts, const MergeOptions& options,
                               std::vector<std::string>* unreadable);

}  // namespace rcme
