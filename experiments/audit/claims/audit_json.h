#pragma once

#include <nlohmann/json_fwd.hpp>

#include "experiments/audit/claims/audit.h"

namespace rcme {

// Claims, conditions, targets, intervals, verdicts. plots/audit.py draws them. Unknown or unbounded numbers
// are null.
nlohmann::ordered_json AuditAsJson(const Audit& audit);

}  // namespace rcme
