#pragma once

#include <optional>

#include "experiments/audit/claims/case.h"

namespace rcme {

// The Cramer-Rao bound of the case's motion (5x5, [rotation, direction], rad^2): the inverse information at
// the true motion and the exact points of the true matches. Nullopt if they do not determine a motion.
std::optional<Matrix5d> CramerRaoBound(const Case& made);

}  // namespace rcme
