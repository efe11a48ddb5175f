#include "experiments/study/find_estimator.h"

#include <fmt/format.h>

#include <algorithm>

#include "parameters/input_error.h"
#include "parameters/suggestion.h"

namespace rcme {

size_t FindLabel(const std::vector<std::string>& labels, const std::string& label, const std::string& owner) {
  const auto found = std::ranges::find(labels, label);
  if (found == labels.end())
    throw InputError(fmt::format("{} has no estimator '{}'{}; allowed: {}", owner, label,
                                 DidYouMean(label, labels), fmt::join(labels, ", ")));
  return static_cast<size_t>(found - labels.begin());
}

}  // namespace rcme
