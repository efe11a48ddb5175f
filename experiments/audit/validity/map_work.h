// The work of `rcme map` (core/work/work_plan.h): an item is a hundred trials of a cell of the map, or one
// sample of a cell of the reference.
#pragma once

#include <optional>
#include <string>

#include "experiments/audit/validity/validity_map.h"
#include "experiments/audit/validity/validity_reference.h"
#include "experiments/core/work/runner.h"

namespace rcme {

struct MapWork {
  ValidityMapOptions map;
  std::optional<ValidityReferenceOptions> reference;  // of the built-in scene alone
  std::string identity;                               // of the study; empty: the built-in scene
};

WorkPlan PlanMapWork(const MapWork& work);

// Gets all results of the runner's shard. Throws as Runner::Get.
void GetMapResults(const MapWork& work, Runner* runner);

// The trials of a cell that results hold, and the counts of the reference; none must be missing. Live no
// longer than their arguments. Throw InputError for a result that is damaged.
TrialsOfCell TrialsIn(const MapWork& work, const WorkPlan& plan, const WorkResults& results);
CountsOfCell CountsIn(const MapWork& work, const WorkPlan& plan, const WorkResults& results);

}  // namespace rcme
