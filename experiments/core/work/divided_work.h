// One shard's part of a work in the making, and the parts of all shards put together.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "experiments/core/work/part_file.h"

namespace rcme {

// The part of a shard, in the file at `path`: what that holds already is not done again. It is written every
// ten seconds, when the work is stopped, and at its end, whole or not at all.
class PartInWork {
 public:
  // Throws InputError if the file holds another part, or could not be written.
  PartInWork(const PiecePlan& plan, const Shard& shard, const std::string& path);

  // Those of these pieces that the part does not hold yet.
  std::vector<PiecePlace> Left(const std::vector<PiecePlace>& places) const;

  // Does the work, which hands its results to Keep. Where a request stops it, throws Stopped with how far it
  // has come.
  void Do(const std::function<void()>& work);
  void Keep(const PiecePlace& place, PieceResult result);

  // Does those that are left one after the other by `compute`, which gives the JSON of a result, and shows
  // progress.
  void DoEach(const std::vector<PiecePlace>& places,
              const std::function<std::string(const PiecePlace&)>& compute);

 private:
  void Write();

  const PiecePlan plan_;
  const std::string path_;
  Part part_;
  size_t num_of_shard_;
  std::chrono::steady_clock::time_point last_write_;
};

// What several parts hold together.
struct MergedParts {
  std::uint32_t num_shards = 1;  // of each part
  std::map<PiecePlace, PieceResult> results;
  std::map<PiecePlace, std::string> paths;  // of the part that a result is from
};

// The parts of the work, in any order and grouping. A piece that two have counts once. Throws InputError that
// names the part and what differs for one of another work, program or number of shards, for one of another
// instruction set than the first, for a piece that is not equal in two parts, and for one that its part
// cannot have.
MergedParts MergeParts(const PiecePlan& plan, const std::vector<std::string>& paths);

// One part that holds what these hold, of whatever work; refused as above.
Part JoinParts(const std::vector<std::string>& paths);

// What the parts lack of these pieces, or of the groups first, ..., end - 1.
struct MissingPieces {
  size_t num_pieces = 0;
  std::vector<std::uint32_t> shards;  // that have them, ascending
};
MissingPieces MissingAmong(const std::vector<PiecePlace>& places, const MergedParts& merged);
MissingPieces MissingIn(const PiecePlan& plan, const MergedParts& merged, size_t first, size_t end);

// What the pieces took, for people: in all, by the slowest shard beside the mean, and by the slowest piece,
// which no shard can take less than.
std::string CostsInWords(const PiecePlan& plan, const MergedParts& merged);

// Hands over the results of these groups, in their order. What `read` cannot read (it throws std::exception)
// is an InputError that names the part and the piece.
void ReadEach(const PiecePlan& plan, const MergedParts& merged, size_t first, size_t end,
              const std::function<void(const PiecePlace&, const std::string& json)>& read);

}  // namespace rcme
