// `rcme map` on many machines: a piece is a hundred trials of a cell of the map, or one sample of a cell of
// the reference (core/work/piece_plan.h).
#pragma once

#include <optional>
#include <string>

#include "experiments/core/work/divided_work.h"
#include "experiments/audit/validity/validity_map.h"
#include "experiments/audit/validity/validity_reference.h"

namespace rcme {

struct MapWork {
  ValidityMapOptions map;
  std::optional<ValidityReferenceOptions> reference;  // of the built-in scene alone
  std::string identity;                               // of the study; empty: the built-in scene
};

PiecePlan PiecesOfMap(const MapWork& work);

// Does the shard's pieces into the file at `path`; what it holds already is not done again. Throws InputError
// if it holds another part, Stopped.
void RunMapPart(const MapWork& work, const Shard& shard, const std::string& path);

// The trials of a cell that the parts hold, and the counts of the reference; none must be missing. Live no
// longer than their arguments. Throw InputError for a result that is damaged.
TrialsOfCell TrialsIn(const MapWork& work, const PiecePlan& pieces, const MergedParts& merged);
CountsOfCell CountsIn(const MapWork& work, const PiecePlan& pieces, const MergedParts& merged);

}  // namespace rcme
