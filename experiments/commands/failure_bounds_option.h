// Failure bounds as the value of an option.
#pragma once

#include <string>

#include "experiments/study/study.h"

namespace rcme {

// "1,5": deg, of the rotation and of the direction. Throws InputError that names --bounds and what is
// allowed.
FailureBounds ParseFailureBounds(const std::string& text);

}  // namespace rcme
