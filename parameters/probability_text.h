#pragma once

#include <string>

namespace rcme {

// A stated probability in two digits. What is below a hundred-thousandth was neglected on the way there:
// "<1e-05".
std::string ProbabilityText(double probability);

}  // namespace rcme
