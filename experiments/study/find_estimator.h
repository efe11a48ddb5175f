// Finds an estimator of a study or a run by its label.
#pragma once

#include <string>
#include <vector>

namespace rcme {

// Returns the index of `label` in `labels`. Throws InputError that begins with `owner` ("--estimator: the
// study") and lists the labels.
size_t FindLabel(const std::vector<std::string>& labels, const std::string& label, const std::string& owner);

// The same for types with a label: EstimatorSpec, DescribedEstimator.
template <typename Estimator>
size_t FindEstimator(const std::vector<Estimator>& estimators, const std::string& label,
                     const std::string& owner) {
  std::vector<std::string> labels;
  for (const Estimator& estimator : estimators) labels.push_back(estimator.label);
  return FindLabel(labels, label, owner);
}

}  // namespace rcme
