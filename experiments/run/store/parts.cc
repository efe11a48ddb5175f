#include "experiments/run/store/parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "experiments/core/files/first_difference.h"
#include "experiments/study/study_lock.h"
#include "parameters/input_error.h"
#include "parameters/parameter.h"

namespace rcme {
namespace {

void CheckSame(const std::string& path, const std::string& first_path, const char* what,
               const std::string& here, const std::string& there) {
  if (here == there) return;
  throw InputError(
      fmt::format("{}: its trials are of {} {}, those of {} of {}: they may differ in their last bits", path,
                  what, here, first_path, there));
}

std::string JoinedNames(const std::string& a, const std::string& b) {
  std::set<std::string> names;
  for (const std::string& list : {a, b}) {
    for (size_t begin = 0; begin < list.size();) {
      const size_t end = std::min(list.find(", ", begin), list.size());
      names.insert(list.substr(begin, end - begin));
      begin = end + 2;
    }
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

// The number of shards: 64 for "3/64", 1 for a whole run.
std::uint32_t ReadNumShards(const RunDescription& run) {
  const size_t slash = run.shard.find('/');
  if (slash == std::string::npos) return 1;
  long long count = 0;
  const bool is_number = ParseInteger(run.shard.substr(slash + 1), &count);
  if (!is_number || count < 1 || count > kMaxShards) throw Damage("'shard' of table run is not possible");
  return static_cast<std::uint32_t>(count);
}

}  // namespace

std::string ShardsOfMerged(const MergeReport& report) {
  if (report.num_missing == 0 || report.num_shards <= 1) return "";
  std::vector<std::uint32_t> whole;
  for (std::uint32_t s = 1; s <= report.num_shards; ++s) {
    if (!std::ranges::binary_search(report.missing_shards, s)) whole.push_back(s);
  }
  return fmt::format("{}/{}", whole.empty() ? "none" : ArrayText(whole), report.num_shards);
}

std::unique_ptr<ResultFile> OpenPart(const std::string& path) {
  RequireResultFile(path);
  return NamingFile(path, [&] {
    auto part = std::make_unique<ResultFile>(path, SQLite::OPEN_READONLY, FileLocks::kNone);
    part->database.exec("BEGIN");
    part->LoadDescription();
    return part;
  });
}

void PartDescriptions::Add(const ResultFile& part) {
  const RunDescription& run = part.description;
  num_trials_ += part.totals.NumTrials();
  if (first_path_.empty()) {
    first_path_ = part.path;
    merged_ = run;
    num_shards_ = ReadNumShards(run);
    if (part.totals.NumTrials() == 0) merged_.origin = {};
    return;
  }
  if (run.identity != merged_.identity) {
    throw InputError(fmt::format("{}: is of another study than {}; first difference: {}", part.path,
                                 first_path_, FirstDifference(merged_.identity, run.identity)));
  }
  if (run.conditions.size() != merged_.conditions.size()) {
    throw Damage(fmt::format("it has {} conditions, {} of the same study has {}", run.conditions.size(),
                             first_path_, merged_.conditions.size()));
  }
  if (run.lock != merged_.lock) {
    throw InputError(fmt::format("{}: was run {}, {} {}: they cannot be merged", part.path,
                                 DescribeLock(run.lock), first_path_, DescribeLock(merged_.lock)));
  }
  if (run.keeps_counts != merged_.keeps_counts) {
    throw InputError(fmt::format("{}: keeps {}, {} keeps {}: they cannot be merged", part.path,
                                 run.keeps_counts ? "counts" : "all trials", first_path_,
                                 merged_.keeps_counts ? "counts" : "all trials"));
  }
  if (run.stopping_rule != merged_.stopping_rule) {
    throw InputError(
        fmt::format("{}: its number of trials was chosen by another rule ('{}') than that of {} "
                    "('{}')",
                    part.path, run.stopping_rule, first_path_, merged_.stopping_rule));
  }
  if (part.totals.NumTrials() > 0) AddOrigin(part);
  if (ReadNumShards(run) != num_shards_) num_shards_ = 0;
  if (run.until_options != merged_.until_options || run.until_trials != merged_.until_trials)
    is_until_known_ = false;
  AddAskedFor(run);
}

RunDescription PartDescriptions::Merged() const {
  RunDescription run = merged_;
  if (!is_until_known_) run.until_options.clear();
  return run;
}

void PartDescriptions::AddOrigin(const ResultFile& part) {
  const TrialOrigin& origin = part.description.origin;
  if (merged_.origin == TrialOrigin()) {
    merged_.origin = origin;
    origin_path_ = part.path;
  }
  const std::string& first = origin_path_.empty() ? first_path_ : origin_path_;
  CheckSame(part.path, first, "program", origin.program, merged_.origin.program);
  if (!options_.are_instruction_sets_mixed)
    CheckSame(part.path, first, "instruction set", origin.instruction_set, merged_.origin.instruction_set);
  merged_.origin.instruction_set = JoinedNames(merged_.origin.instruction_set, origin.instruction_set);
}

// The texts, such as the study's name and description, come from the part that planned most trials.
void PartDescriptions::AddAskedFor(const RunDescription& run) {
  std::vector<DescribedCondition> conditions = merged_.conditions;
  for (size_t c = 0; c < conditions.size(); ++c)
    conditions[c].num_trials = std::max(conditions[c].num_trials, run.conditions.at(c).num_trials);
  if (std::tie(run.trials, run.study_yaml) > std::tie(merged_.trials, merged_.study_yaml)) {
    const RunDescription before = merged_;
    merged_ = run;
    merged_.until_options = before.until_options;
    merged_.until_trials = before.until_trials;
    merged_.origin = before.origin;
    merged_.retried_trials = before.retried_trials;
    merged_.despite_lock = before.despite_lock;
  }
  merged_.despite_lock = JoinReasons(merged_.despite_lock, run.despite_lock);
  merged_.retried_trials += run.retried_trials;
  merged_.conditions = std::move(conditions);
}

PartDescriptions DescribeParts(const std::vector<std::string>& parts, const MergeOptions& options,
                               std::vector<std::string>* unreadable) {
  PartDescriptions descriptions(options);
  for (const std::string& path : parts) {
    std::unique_ptr<ResultFile> part;
    try {
      part = OpenPart(path);
    } catch (const InputError& error) {
      if (!unreadable) throw;
      unreadable->push_back(error.what());
      continue;
    }
    NamingFile(path, [&] { descriptions.Add(*part); });
  }
  if (descriptions.IsEmpty())
    throw InputError(fmt::format("no part can be read: {}", fmt::join(*unreadable, "; ")));
  return descriptions;
}

}  // namespace rcme
