#include "experiments/core/work/shard.h"

#include <fmt/format.h>

#include <cstdlib>

#include "parameters/input_error.h"
#include "parameters/parameter.h"
#include "parameters/plain_text.h"

namespace rcme {
namespace {

constexpr const char* kAllowed =
    "give I/N with 1 <= I <= N <= 1000000, auto/N in a task of a Slurm array that begins at 1 or of a "
    "Kubernetes job with indexed completion, or auto in a Slurm array";

[[noreturn]] void ThrowForShard(const std::string& text, const std::string& what) {
  throw InputError(fmt::format("--shard: {} {}; {}", Quoted(text), what, kAllowed));
}

std::optional<long long> Number(const std::string& text) {
  long long number = 0;
  return ParseInteger(text, &number) ? std::optional(number) : std::nullopt;
}

// A whole number that the scheduler sets; std::nullopt if the variable is not set.
std::optional<long long> NumberIn(const Environment& environment, const std::string& name) {
  const std::optional<std::string> text = environment(name);
  if (!text) return std::nullopt;
  const std::optional<long long> number = Number(*text);
  if (!number || *number < 0)
    throw InputError(fmt::format("--shard: {} is {}, which is not a whole number", name, Quoted(*text)));
  return number;
}

// For "auto/N": the number of this task, from 1.
long long TaskNumber(const std::string& text, const Environment& environment) {
  if (const auto task = NumberIn(environment, "SLURM_ARRAY_TASK_ID")) return *task;
  if (const auto index = NumberIn(environment, "JOB_COMPLETION_INDEX")) return *index + 1;
  ThrowForShard(text, "is not known here: neither SLURM_ARRAY_TASK_ID nor JOB_COMPLETION_INDEX is set");
}

// For "auto": the array's task count is the number of shards. An array submitted again in part is refused,
// because its count is that of the part.
Shard ShardOfArray(const std::string& text, const Environment& environment) {
  const auto task = NumberIn(environment, "SLURM_ARRAY_TASK_ID");
  const auto count = NumberIn(environment, "SLURM_ARRAY_TASK_COUNT");
  if (!task || !count)
    ThrowForShard(text, "is not known here: SLURM_ARRAY_TASK_ID or SLURM_ARRAY_TASK_COUNT is not set");
  const long long first = NumberIn(environment, "SLURM_ARRAY_TASK_MIN").value_or(1);
  const long long last = NumberIn(environment, "SLURM_ARRAY_TASK_MAX").value_or(first + *count - 1);
  if (last - first + 1 != *count || *task < first || *task > last || *count > kMaxShards) {
    ThrowForShard(text, fmt::format("is not known here: the array has {} tasks from {} to {}, a part of "
                                    "another perhaps",
                                    *count, first, last));
  }
  return {static_cast<std::uint32_t>(*task - first + 1), static_cast<std::uint32_t>(*count)};
}

}  // namespace

std::string Shard::Text() const { return count == 1 ? "" : fmt::format("{}/{}", number, count); }

Environment ThisEnvironment() {
  return [](const std::string& name) -> std::optional<std::string> {
    const char* value = std::getenv(name.c_str());
    return value ? std::optional<std::string>(value) : std::nullopt;
  };
}

Shard ParseShard(const std::string& text, const Environment& environment) {
  if (text == "auto") return ShardOfArray(text, environment);
  const size_t slash = text.find('/');
  if (slash == std::string::npos) ThrowForShard(text, "is not allowed");
  const std::string first = text.substr(0, slash);
  const auto count = Number(text.substr(slash + 1));
  const auto number = first == "auto" ? TaskNumber(text, environment) : Number(first);
  if (!number || !count || *count < 1 || *count > kMaxShards) ThrowForShard(text, "is not allowed");
  if (*number < 1 || *number > *count)
    ThrowForShard(text, fmt::format("is not allowed: there is no shard {} of {}", *number, *count));
  return {static_cast<std::uint32_t>(*number), static_cast<std::uint32_t>(*count)};
}

std::uint32_t FindShard(std::uint32_t condition, std::uint32_t scene, std::uint32_t count) {
  // frac(c / golden ratio) in units of 2^-32, without rounding that could differ between machines.
  constexpr std::uint32_t kGolden = 2654435769;  // 2^32 / 1.6180...
  const std::uint32_t fraction = condition * kGolden;
  const std::uint64_t offset = std::uint64_t{fraction} * count >> 32;
  return static_cast<std::uint32_t>((scene + offset) % count) + 1;
}

ShardTrials::ShardTrials(const Shard& shard, std::uint32_t condition, int repeats_per_scene)
    : count_(shard.count),
      first_scene_((shard.number + shard.count - FindShard(condition, 0, shard.count)) % shard.count),
      repeats_(static_cast<std::uint32_t>(repeats_per_scene)) {}

bool ShardTrials::Has(std::uint32_t trial) const { return trial / repeats_ % count_ == first_scene_; }

std::uint32_t ShardTrials::NumBefore(std::uint32_t trial) const {
  const std::uint32_t scene = trial / repeats_;
  const std::uint32_t num_scenes = scene > first_scene_ ? (scene - first_scene_ - 1) / count_ + 1 : 0;
  return num_scenes * repeats_ + (Has(trial) ? trial % repeats_ : 0);
}

std::uint32_t ShardTrials::TrialAt(std::uint32_t place) const {
  return (first_scene_ + place / repeats_ * count_) * repeats_ + place % repeats_;
}

std::string ArrayText(const std::vector<std::uint32_t>& numbers) {
  std::string text;
  for (size_t i = 0; i < numbers.size();) {
    size_t end = i + 1;
    while (end < numbers.size() && numbers[end] == numbers[end - 1] + 1) ++end;
    text += fmt::format("{}{}", text.empty() ? "" : ",", numbers[i]);
    if (end - i > 1) text += fmt::format("-{}", numbers[end - 1]);
    i = end;
  }
  return text;
}

}  // namespace rcme
