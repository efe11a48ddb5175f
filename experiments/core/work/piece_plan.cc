#include "experiments/core/work/piece_plan.h"

#include <fmt/format.h>

namespace rcme {

bool PiecePlan::Has(const PiecePlace& place) const {
  return place.group < groups.size() && place.piece < groups[place.group].num_pieces;
}

size_t PiecePlan::NumPieces() const {
  size_t sum = 0;
  for (const PieceGroup& group : groups) sum += group.num_pieces;
  return sum;
}

std::string IdentityOf(const PiecePlan& plan) {
  std::string identity = plan.identity;
  for (const PieceGroup& group : plan.groups) {
    identity += fmt::format("{}: {} {}s\n", group.name, group.num_pieces, plan.piece_name);
  }
  return identity;
}

std::uint32_t ShardOfPiece(const PiecePlace& place, std::uint32_t count) {
  return ShardOf(static_cast<std::uint32_t>(place.group), static_cast<std::uint32_t>(place.piece), count);
}

std::vector<PiecePlace> PiecesOf(const PiecePlan& plan, const Shard& shard, size_t first, size_t end) {
  std::vector<PiecePlace> places;
  for (size_t group = first; group < end; ++group) {
    for (size_t piece = 0; piece < plan.groups[group].num_pieces; ++piece) {
      if (ShardOfPiece({group, piece}, shard.count) == shard.number) places.push_back({group, piece});
    }
  }
  return places;
}

std::vector<PiecePlace> PiecesOf(const PiecePlan& plan, const Shard& shard) {
  return PiecesOf(plan, shard, 0, plan.groups.size());
}

}  // namespace rcme
