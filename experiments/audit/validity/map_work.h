// The work of `rcme map` (core/work/work_plan.h). An item is a hundred trials of a cell of the map, or one
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
  std::optional<ValidityReferenceOptions> reference;  // only for the built-in scene
  std::string identity;                               // of the study; empty: the built-in scene
};

WorkPlan PlanMapWork(const MapWork& work);

// Gets all results of the runner's shard. Throws as Runner::Get.
void GetMapResults(const MapWork& work, Runner* runner);

// The trials of a cell and the counts of the reference, read from results. No result may be missing. They
// must not outlive their arguments. Throw InputError for a damaged result.
TrialsOfCell TrialsIn(const MapWork& work, const WorkPlan& plan, const WorkResults& results);
CountsOfCell CountsIn(const MapWork& work, const WorkPlan& plan, const WorkResults& results);

}  // namespace rcme
