// A shard is a fixed share of a study's trials. Many machines can compute a study, each its shard into a file
// of its own.
//
// Shard i of n has the scenes s of condition c with (s + offset(c)) mod n = i - 1, where offset(c) =
// floor(n frac(c / golden ratio)). A scene is a trial, or the repeats_per_scene trials that share it. Every
// condition is thus divided evenly to within one scene, whatever its trials cost. The offsets are a golden
// rotation, whose points are evenly spread in any number, so a different shard has the extra scene in each
// condition. The shard of a trial does not depend on the number of trials or on what has been computed, so a
// run in shards can be extended.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace rcme {

inline constexpr std::uint32_t kMaxShards = 1'000'000;

struct Shard {
  std::uint32_t number = 1, count = 1;  // shard 1, ..., count; of one: all trials

  // "3/64"; empty for all trials.
  std::string Text() const;
  bool operator==(const Shard&) const = default;
};

// The value of an environment variable, if it is set.
using Environment = std::function<std::optional<std::string>(const std::string& name)>;
Environment ThisEnvironment();

// Parses the value of --shard:
//   "3/64"     shard 3 of 64
//   "auto/64"  the number is that of the task: SLURM_ARRAY_TASK_ID of an array that begins at 1, or
//              JOB_COMPLETION_INDEX + 1
//   "auto"     number and count are those of a whole Slurm array, which may begin at any number
// Throws InputError for other text, and if the scheduler's variables are missing or do not fit.
Shard ParseShard(const std::string& text, const Environment& environment);

// The number (1, ..., count) of the shard that has this scene.
std::uint32_t FindShard(std::uint32_t condition, std::uint32_t scene, std::uint32_t count);

// The trials of one condition that belong to a shard. Their places number them 0, 1, 2, ... within the shard.
class ShardTrials {
 public:
  ShardTrials() = default;  // all trials of a condition
  ShardTrials(const Shard& shard, std::uint32_t condition, int repeats_per_scene);

  bool Has(std::uint32_t trial) const;
  // The number of the shard's trials among 0, ..., trial - 1. This is the place of `trial` if Has(trial).
  std::uint32_t NumBefore(std::uint32_t trial) const;
  std::uint32_t TrialAt(std::uint32_t place) const;

 private:
  std::uint32_t count_ = 1, first_scene_ = 0, repeats_ = 1;
};

// Formats ascending numbers as sbatch --array takes them: "3,17-19".
std::string ArrayText(const std::vector<std::uint32_t>& numbers);

}  // namespace rcme
