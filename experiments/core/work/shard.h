// A fixed share of a study's trials, so that many machines compute them, each into a file of its own.
//
// Shard i of n has those scenes s of condition c with (s + offset(c)) mod n = i - 1, where offset(c) =
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

// What --shard says: "3/64"; "auto/64", the number of which is that of the task (SLURM_ARRAY_TASK_ID of an
// array that begins at 1, or JOB_COMPLETION_INDEX + 1); "auto", the task of a whole Slurm array, whatever it
// begins with. Throws InputError.
Shard ParseShard(const std::string& text, const Environment& environment);

// The number of the shard, of `count`, that has this scene.
std::uint32_t FindShard(std::uint32_t condition, std::uint32_t scene, std::uint32_t count);

// The trials that a shard has of one condition. They are numbered here by their place, 0, 1, 2, ...
class ShardTrials {
 public:
  ShardTrials() = default;  // all trials of a condition
  ShardTrials(const Shard& shard, std::uint32_t condition, int repeats_per_scene);

  bool Has(std::uint32_t trial) const;
  // How many of them are among the trials 0, ..., trial - 1: the place of `trial`, if it is one of them.
  std::uint32_t NumBefore(std::uint32_t trial) const;
  std::uint32_t TrialAt(std::uint32_t place) const;

 private:
  std::uint32_t count_ = 1, first_scene_ = 0, repeats_ = 1;
};

// Numbers, ascending, as Slurm wants the tasks of an array: "3,17-19".
std::string ArrayText(const std::vector<std::uint32_t>& numbers);

}  // namespace rcme
