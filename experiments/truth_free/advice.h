#pragma once

#include <string>
#include <vector>

#include "experiments/truth_free/validate.h"

namespace rcme {

// What to change, in words, from all else that the report says.
std::vector<std::string> AdviceOn(const SetReport& report);

}  // namespace rcme
