#pragma once

#include <nlohmann/json_fwd.hpp>

#include "experiments/audit/claims/audit.h"

namespace rcme {

// Claims, conditions, targets, intervals, verdicts; the input of plots/audit.py. Unknown or unbounded numbers
// are null.
nlohmann::ordered_json AuditAsJson(const Audit& audit);

}  // namespace rcme
