#include "experiments/core/work/divided_work.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <new>
#include <set>
#include <utility>

#include "estimator/instruction_set.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/text/program_name.h"
#include "experiments/core/work/progress.h"
#include "experiments/core/work/stop_request.h"
#include "experiments/core/work/thread_time.h"
#include "experiments/core/files/first_difference.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

void RequireSame(const std::string& path, const std::string& other, const std::string& what,
                 const std::string& there, const std::string& here) {
  if (there == here) return;
  throw InputError(
      fmt::format("{}: does not belong to {}: {}, {}", path, other, what, FirstDifference(there, here)));
}

// What every part of the work has in common with its plan.
void RequirePartOf(const PiecePlan& plan, const std::string& path, const Part& part) {
  const std::string here = "this " + plan.work;
  RequireSame(path, here, "another work", part.work, plan.work);
  RequireSame(path, here, "another program", part.origin.program, ProgramName());
  RequireSame(path, here, "another " + plan.work, part.identity, AsStored(IdentityOf(plan)));
  for (const auto& [place, result] : part.results) {
    const bool is_its_own =
        part.shard.number == 0 || ShardOfPiece(place, part.shard.count) == part.shard.number;
    if (!plan.Has(place) || !is_its_own)
      throw InputError(fmt::format("{}: damaged: {} {} of group {} is none of its shard", path,
                                   plan.piece_name, place.piece, place.group));
  }
}

std::string NumberInWords(const Shard& shard) { return fmt::format("{}/{}", shard.number, shard.count); }

// The part as the file at `path` has it, or a new one.
Part OpenPart(const PiecePlan& plan, const Shard& shard, const std::string& path) {
  Part part{plan.work, IdentityOf(plan), shard, {ProgramName(), InstructionSetName()}, {}};
  if (!std::filesystem::exists(path)) {
    CheckCanBeWritten(path);
    return part;
  }
  Part before = ReadPart(path);
  RequirePartOf(plan, path, before);
  RequireSame(path, "this command", "another shard", NumberInWords(before.shard), NumberInWords(shard));
  RequireSame(path, "this machine", "another instruction set", before.origin.instruction_set,
              part.origin.instruction_set);
  return before;
}

// What two parts have to have in common.
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

std::string InWords(const PiecePlan& plan, const PiecePlace& place) {
  if (!plan.Has(place)) return fmt::format("piece {} of group {}", place.piece, place.group);
  return fmt::format("{} {} of {}", plan.piece_name, place.piece, plan.groups[place.group].name);
}

// Reads the parts one after the other; `check` looks at each.
MergedParts ReadParts(const PiecePlan& plan, const std::vector<std::string>& paths, Part* first,
                      const std::function<void(const std::string& path, const Part& part)>& check) {
  MergedParts merged;
  for (const std::string& path : paths) {
    Part part = ReadPart(path);
    check(path, part);
    if (path == paths.front()) *first = {part.work, part.identity, {0, part.shard.count}, part.origin, {}};
    RequireTogether(path, part, paths.front(), *first);
    for (auto& [place, result] : part.results) {
      const auto [source, is_new] = merged.paths.emplace(place, path);
      const PieceResult& known = merged.results.emplace(place, result).first->second;
      if (!is_new && known.json != result.json)
        throw InputError(
            fmt::format("{}: {} is not equal to that of {}", path, InWords(plan, place), source->second));
    }
  }
  merged.num_shards = first->shard.count;
  return merged;
}

}  // namespace

PartInWork::PartInWork(const PiecePlan& plan, const Shard& shard, const std::string& path)
    : plan_(plan),
      path_(path),
      part_(OpenPart(plan, shard, path)),
      num_of_shard_(PiecesOf(plan, shard).size()),
      last_write_(std::chrono::steady_clock::now()) {}

std::vector<PiecePlace> PartInWork::Left(const std::vector<PiecePlace>& places) const {
  std::vector<PiecePlace> left;
  for (const PiecePlace& place : places) {
    if (!part_.results.contains(place)) left.push_back(place);
  }
  return left;
}

void PartInWork::Do(const std::function<void()>& work) {
  try {
    work();
  } catch (const Stopped&) {
    Write();
    throw Stopped(fmt::format("stopped; {} has {} of at most {} {}s, the same command goes on", path_,
                              part_.results.size(), num_of_shard_, plan_.piece_name));
  }
  Write();
}

void PartInWork::Keep(const PiecePlace& place, PieceResult result) {
  constexpr std::chrono::seconds kBetweenWrites{10};
  part_.results.emplace(place, std::move(result));
  if (std::chrono::steady_clock::now() - last_write_ >= kBetweenWrites) Write();
}

void PartInWork::DoEach(const std::vector<PiecePlace>& places,
                        const std::function<std::string(const PiecePlace&)>& compute) {
  const std::vector<PiecePlace> left = Left(places);
  const auto num_pieces = static_cast<std::int64_t>(places.size());
  Progress progress(plan_.piece_name + "s", num_pieces, num_pieces - static_cast<std::int64_t>(left.size()));
  Do([&] {
    for (const PiecePlace& place : left) {
      if (IsStopRequested()) throw Stopped("stopped");
      const double before = ProcessSeconds();
      std::string json = compute(place);
      Keep(place, {std::move(json), ProcessSeconds() - before});
      progress.Advance(1);
    }
  });
}

void PartInWork::Write() {
  WritePart(path_, part_);
  last_write_ = std::chrono::steady_clock::now();
}

MergedParts MergeParts(const PiecePlan& plan, const std::vector<std::string>& paths) {
  Part first;
  return ReadParts(plan, paths, &first,
                   [&](const std::string& path, const Part& part) { RequirePartOf(plan, path, part); });
}

Part JoinParts(const std::vector<std::string>& paths) {
  Part joined;
  joined.results = ReadParts({}, paths, &joined, [](const std::string&, const Part&) {}).results;
  return joined;
}

MissingPieces MissingAmong(const std::vector<PiecePlace>& places, const MergedParts& merged) {
  MissingPieces missing;
  std::set<std::uint32_t> shards;
  for (const PiecePlace& place : places) {
    if (merged.results.contains(place)) continue;
    ++missing.num_pieces;
    shards.insert(ShardOfPiece(place, merged.num_shards));
  }
  missing.shards.assign(shards.begin(), shards.end());
  return missing;
}

MissingPieces MissingIn(const PiecePlan& plan, const MergedParts& merged, size_t first, size_t end) {
  return MissingAmong(PiecesOf(plan, Shard{}, first, end), merged);
}

std::string CostsInWords(const PiecePlan& plan, const MergedParts& merged) {
  std::vector<double> shards(merged.num_shards);
  double sum = 0.0, slowest = 0.0;
  PiecePlace where;
  for (const auto& [place, result] : merged.results) {
    sum += result.seconds;
    shards[ShardOfPiece(place, merged.num_shards) - 1] += result.seconds;
    if (result.seconds > slowest) slowest = result.seconds, where = place;
  }
  if (sum <= 0.0) return "the pieces took no time";
  const double mean = sum / static_cast<double>(shards.size());
  return fmt::format(
      "processor time {:.4g} s; the slowest of {} shards {:.2f} times the mean, the slowest {} {:.2f} times "
      "({})",
      sum, shards.size(), std::ranges::max(shards) / mean, plan.piece_name, slowest / mean,
      InWords(plan, where));
}

void ReadEach(const PiecePlan& plan, const MergedParts& merged, size_t first, size_t end,
              const std::function<void(const PiecePlace&, const std::string&)>& read) {
  const auto stop = merged.results.lower_bound({end, 0});
  for (auto piece = merged.results.lower_bound({first, 0}); piece != stop; ++piece) {
    const auto& [place, result] = *piece;
    try {
      read(place, result.json);
    } catch (const std::bad_alloc&) {
      throw;  // no damage of the part's
    } catch (const std::exception& error) {
      throw InputError(
          fmt::format("{}: damaged: {}: {}", merged.paths.at(place), InWords(plan, place), error.what()));
    }
  }
}

}  // namespace rcme
