// Failure bounds as the value of an option.
#pragma once

#include <string>

#include "experiments/study/study.h"

namespace rcme {

// Parses "1,5": the bounds on the rotation and direction errors, deg. Throws InputError that names --bounds
// and the allowed values.
FailureBounds ParseFailureBounds(const std::string& text);

}  // namespace rcme
