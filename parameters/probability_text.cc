#include "parameters/probability_text.h"

#include <fmt/format.h>

namespace rcme {

std::string ProbabilityText(double probability) {
  return probability < 1e-5 ? "<1e-05" : fmt::format("{:.2g}", probability);
}

}  // namespace rcme
