#pragma once

#include <string>

namespace rcme {

// A probability in two digits; "<1e-05" below 1e-5, as smaller contributions were neglected in its
// computation.
std::string ProbabilityText(double probability);

}  // namespace rcme
