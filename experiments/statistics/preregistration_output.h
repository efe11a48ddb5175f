#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "experiments/statistics/preregistration.h"

namespace rcme {

// Formats the result for people and for programs.
std::string PreregistrationAsText(const Preregistration& preregistration);
nlohmann::ordered_json PreregistrationAsJson(const Preregistration& preregistration);

}  // namespace rcme
