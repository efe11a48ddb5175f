#include "experiments/core/work/runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <new>
#include <set>
#include <stdexcept>
#include <utility>

#include "estimator/instruction_set.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/files/first_difference.h"
#include "experiments/core/text/message.h"
#include "experiments/core/text/program_name.h"
#include "experiments/core/work/for_each_index.h"
#include "experiments/core/work/progress.h"
#include "experiments/core/work/thread_time.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kWriteInterval{10};

void RequireSame(const std::string& path, const std::string& other, const std::string& what,
                 const std::string& there, const std::string& here) {
  if (there == here) return;
  throw InputError(
      fmt::format("{}: does not belong to {}: {}, {}", path, other, what, FirstDifference(there, here)));
}

// Throws InputError unless the part is of the plan's work and its items are of its shard.
void RequireMatchingPart(const WorkPlan& plan, const std::string& path, const Part& part) {
  const std::string here = "this " + plan.work;
  RequireSame(path, here, "another work", part.work, plan.work);
  RequireSame(path, here, "another program", part.origin.program, ProgramName());
  RequireSame(path, here, "another " + plan.work, part.identity, AsStored(DescribeIdentity(plan)));
  for (const auto& [place, result] : part.results) {
    const bool is_its_own =
        part.shard.number == 0 || FindShardOfItem(place, part.shard.count) == part.shard.number;
    if (!plan.Has(place) || !is_its_own)
      throw InputError(fmt::format("{}: damaged: {} {} of group {} is none of its shard", path,
                                   plan.item_name, place.item, place.group));
  }
}

std::string DescribeShard(const Shard& shard) { return fmt::format("{}/{}", shard.number, shard.count); }

// Throws InputError unless the part can be merged with the first one.
void RequireTogether(const std::string& path, const Part& part, const std::string& first_path,
                     const Part& first) {
  RequireSame(path, first_path, "another work", part.work, first.work);
  RequireSame(path, first_path, "another program", part.origin.program, first.origin.program);
  RequireSame(path, first_path, "another " + part.work, part.identity, first.identity);
  RequireSame(path, first_path, "another number of shards", fmt::format("{}", part.shard.count),
              fmt::format("{}", first.shard.count));
  RequireSame(path, first_path, "another instruction set", part.origin.instruction_set,
              first.origin.instruction_set);
}

std::string DescribeItem(const WorkPlan& plan, const ItemPlace& place) {
  if (plan.is_open) return fmt::format("{} {}", plan.item_name, place.item);
  if (!plan.Has(place)) return fmt::format("item {} of group {}", place.item, place.group);
  return fmt::format("{} {} of {}", plan.item_name, place.item, plan.groups[place.group].name);
}

// Reads the parts one after the other; `check` looks at each.
WorkResults ReadParts(const WorkPlan& plan, const std::vector<std::string>& paths, Part* first,
                      const std::function<void(const std::string& path, const Part& part)>& check) {
  WorkResults merged;
  for (const std::string& path : paths) {
    Part part = ReadPart(path);
    check(path, part);
    if (path == paths.front()) *first = {part.work, part.identity, {0, part.shard.count}, part.origin, {}};
    RequireTogether(path, part, paths.front(), *first);
    for (auto& [place, result] : part.results) {
      const auto [source, is_new] = merged.paths.emplace(place, path);
      const ItemResult& known = merged.results.emplace(place, result).first->second;
      if (!is_new && known.json != result.json)
        throw InputError(fmt::format("{}: {} is not equal to that of {}", path, DescribeItem(plan, place),
                                     source->second));
    }
  }
  merged.num_shards = first->shard.count;
  return merged;
}

}  // namespace

Runner::Runner(Kind kind, const WorkPlan& plan, const Shard& shard, const std::string& path, int num_threads)
    : kind_(kind),
      plan_(plan),
      num_threads_(num_threads),
      path_(path),
      part_{plan.work, DescribeIdentity(plan), shard, {ProgramName(), InstructionSetName()}, {}},
      next_write_(Clock::now() + kWriteInterval) {
  if (!path_.empty()) OpenFile();
}

Runner Runner::InMemory(const WorkPlan& plan, int num_threads) {
  return {Kind::kMemory, plan, {}, "", num_threads};
}

Runner Runner::WithCheckpoint(const WorkPlan& plan, const std::string& path, int num_threads) {
  return {Kind::kCheckpoint, plan, {}, path, num_threads};
}

Runner Runner::OfShard(const WorkPlan& plan, const Shard& shard, const std::string& path, int num_threads) {
  return {Kind::kShard, plan, shard, path, num_threads};
}

Runner Runner::FromParts(const WorkPlan& plan, const std::vector<std::string>& paths) {
  Runner runner(Kind::kParts, plan, {}, "", 1);
  runner.results_ = MergeParts(plan, paths);
  return runner;
}

// Continues from the file, if it exists.
void Runner::OpenFile() {
  if (!std::filesystem::exists(path_)) return CheckCanBeWritten(path_);
  SalvagedPart salvaged = SalvagePart(path_);
  Part& before = salvaged.part;
  try {
    RequireMatchingPart(plan_, path_, before);
    RequireSame(path_, "this command", "another shard", DescribeShard(before.shard),
                DescribeShard(part_.shard));
    RequireSame(path_, "this machine", "another instruction set", before.origin.instruction_set,
                part_.origin.instruction_set);
  } catch (const InputError& error) {
    if (kind_ == Kind::kShard) throw;
    throw InputError(fmt::format("{}; remove the file or choose another --out", error.what()));
  }
  if (!salvaged.damage.empty())
    PrintMessage("warning: {}; {} sound {}s are kept, {} of the file are lost and made again\n",
                 salvaged.damage, before.results.size(), plan_.item_name, salvaged.num_lost);
  results_.results = std::move(before.results);
  results_.kept_in = path_;
  num_written_ = results_.results.size();
}

void Runner::Get(const std::vector<ItemPlace>& places, const ComputeItem& compute, const ProgressUnit& unit) {
  if (kind_ == Kind::kParts)
    return RequireNoneMissing(plan_, FindMissingAmong(places, results_), results_.num_shards);
  ComputeAll(places, compute, unit);
  Flush();
}

void Runner::GetOne(const ItemPlace& place, const ComputeItem& compute) {
  if (kind_ == Kind::kParts) throw std::logic_error("GetOne: an open plan has no parts");
  if (results_.results.contains(place)) return;
  FinishItems(1, 1, nullptr, this, [&](std::int64_t) {
    ComputeOne(place, compute);
    return 1;
  });
}

void Runner::ComputeAll(const std::vector<ItemPlace>& places, const ComputeItem& compute,
                        const ProgressUnit& unit) {
  const auto amount_in = [&](const ItemPlace& place) { return unit.amount ? unit.amount(place) : 1; };
  std::vector<ItemPlace> left;
  std::int64_t total = 0, done = 0;
  for (const ItemPlace& place : places) {
    const bool is_done = results_.results.contains(place);
    total += amount_in(place);
    if (is_done) done += amount_in(place);
    if (!is_done) left.push_back(place);
  }
  Progress progress(unit.amount ? unit.name : plan_.item_name + "s", total, done);
  FinishItems(std::ssize(left), num_threads_, &progress, this, [&](std::int64_t index) {
    const ItemPlace& place = left[static_cast<size_t>(index)];
    ComputeOne(place, compute);
    return amount_in(place);
  });
}

void Runner::ComputeOne(const ItemPlace& place, const ComputeItem& compute) {
  // Several items run at the same time, or one that has threads of its own.
  const auto seconds = NumThreads(num_threads_) > 1 ? ThreadSeconds : ProcessSeconds;
  const double before = seconds();
  std::string json = compute(place);
  Keep(place, {std::move(json), seconds() - before});
}

void Runner::Keep(const ItemPlace& place, ItemResult result) {
  const std::lock_guard lock(*mutex_);
  results_.results.emplace(place, std::move(result));
  if (Clock::now() >= next_write_) Flush();
}

void Runner::Flush() {
  if (path_.empty() || is_too_long_) return;
  const Clock::time_point begin = Clock::now();
  try {
    WritePart(path_, part_, results_.results);
    num_written_ = results_.results.size();
  } catch (const PartIsTooLong& error) {
    if (kind_ == Kind::kShard) throw;
    is_too_long_ = true;
    PrintMessage("warning: {}: what follows is not kept until the end\n", error.what());
  } catch (const InputError& error) {
    throw KeptResultsError(error.what());
  }
  // Writing takes at most about a tenth of the time; the largest file takes a second.
  const auto pause = 10 * (Clock::now() - begin);
  next_write_ = Clock::now() + std::max<Clock::duration>(kWriteInterval, pause);
}

std::string Runner::DescribeKept(std::int64_t) const {
  if (path_.empty()) return "stopped; nothing was kept";
  const std::string most =
      plan_.is_open ? "" : fmt::format("of at most {} ", ListItems(plan_, part_.shard).size());
  return fmt::format("stopped; {} has {} {}{}s, the same command goes on", path_, num_written_, most,
                     plan_.item_name);
}

void Runner::RemoveCheckpoint() {
  if (kind_ == Kind::kCheckpoint) std::filesystem::remove(path_);
}

WorkResults MergeParts(const WorkPlan& plan, const std::vector<std::string>& paths) {
  Part first;
  return ReadParts(plan, paths, &first,
                   [&](const std::string& path, const Part& part) { RequireMatchingPart(plan, path, part); });
}

Part JoinParts(const std::vector<std::string>& paths) {
  Part joined;
  joined.results = ReadParts({}, paths, &joined, [](const std::string&, const Part&) {}).results;
  return joined;
}

MissingItems FindMissingAmong(const std::vector<ItemPlace>& places, const WorkResults& merged) {
  MissingItems missing;
  std::set<std::uint32_t> shards;
  for (const ItemPlace& place : places) {
    if (merged.results.contains(place)) continue;
    ++missing.num_items;
    shards.insert(FindShardOfItem(place, merged.num_shards));
  }
  missing.shards.assign(shards.begin(), shards.end());
  return missing;
}

void RequireNoneMissing(const WorkPlan& plan, const MissingItems& missing, std::uint32_t num_shards) {
  if (missing.num_items == 0) return;
  const std::string shards = ArrayText(missing.shards);
  throw ItemsAreMissing{fmt::format("{} {}s are missing, of the shards {} of {}; no result was written",
                                    missing.num_items, plan.item_name, shards, num_shards),
                        shards};
}

MissingItems FindMissingIn(const WorkPlan& plan, const WorkResults& merged, size_t first, size_t end) {
  return FindMissingAmong(ListItems(plan, Shard{}, first, end), merged);
}

std::string DescribeCosts(const WorkPlan& plan, const WorkResults& merged) {
  std::vector<double> shards(merged.num_shards);
  double sum = 0.0, slowest = 0.0;
  ItemPlace where;
  for (const auto& [place, result] : merged.results) {
    sum += result.seconds;
    shards[FindShardOfItem(place, merged.num_shards) - 1] += result.seconds;
    if (result.seconds > slowest) slowest = result.seconds, where = place;
  }
  if (sum <= 0.0) return "the pieces took no time";
  const double mean = sum / static_cast<double>(shards.size());
  return fmt::format(
      "processor time {:.4g} s; the slowest of {} shards {:.2f} times the mean, the slowest {} {:.2f} times "
      "({})",
      sum, shards.size(), std::ranges::max(shards) / mean, plan.item_name, slowest / mean,
      DescribeItem(plan, where));
}

void ReadResult(const WorkPlan& plan, const WorkResults& results, const ItemPlace& place,
                const ReadItem& read) {
  try {
    read(place, results.results.at(place).json);
  } catch (const std::bad_alloc&) {
    throw;  // the part is not damaged
  } catch (const std::exception& error) {
    const auto path = results.paths.find(place);
    throw KeptResultsError(fmt::format("{}: damaged: {}: {}",
                                       path == results.paths.end() ? results.kept_in : path->second,
                                       DescribeItem(plan, place), error.what()));
  }
}

void ReadResults(const WorkPlan& plan, const WorkResults& results, size_t first, size_t end,
                 const ReadItem& read) {
  const auto stop = results.results.lower_bound({end, 0});
  for (auto one = results.results.lower_bound({first, 0}); one != stop; ++one)
    ReadResult(plan, results, one->first, read);
}

}  // namespace rcme
