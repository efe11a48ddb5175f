// A work that many machines divide: an audit, a tuning, a transfer, a map. It consists of pieces, each a pure
// function of the plan, in groups of like cost; a shard (core/work/shard.h) has a fixed share of them.
#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <vector>

#include "experiments/core/work/shard.h"

namespace rcme {

// Indices into PiecePlan::groups and into the group's pieces.
struct PiecePlace {
  size_t group = 0, piece = 0;
  auto operator<=>(const PiecePlace&) const = default;
};

struct PieceGroup {
  std::string name;  // for messages: "claim sigma_f.seven_point"
  size_t num_pieces = 0;
};

struct PiecePlan {
  std::string work;        // what the command makes: "audit"
  std::string piece_name;  // "check"
  std::string identity;    // what the results depend on, a line for each thing
  std::vector<PieceGroup> groups;

  bool Has(const PiecePlace& place) const;
  size_t NumPieces() const;
};

// Equal for the parts of one work: its identity, then its groups.
std::string IdentityOf(const PiecePlan& plan);

// The shard that has the piece: ShardOf (core/work/shard.h) of group and piece, so that the pieces of every
// group, cheap or dear, are divided evenly to within one.
std::uint32_t ShardOfPiece(const PiecePlace& place, std::uint32_t count);

// Those of the shard in the groups first, ..., end - 1, in their order.
std::vector<PiecePlace> PiecesOf(const PiecePlan& plan, const Shard& shard, size_t first, size_t end);
std::vector<PiecePlace> PiecesOf(const PiecePlan& plan, const Shard& shard);

}  // namespace rcme
