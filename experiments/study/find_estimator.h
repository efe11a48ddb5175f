// The estimator that a label names, of a study or of a run.
#pragma once

#include <string>
#include <vector>

namespace rcme {

// The place of a label among those of the estimators. Throws InputError that begins with `owner`
// ("--estimator: the study") and lists them.
size_t FindLabel(const std::vector<std::string>& labels, const std::string& label, const std::string& owner);

// The same of anything that has a label: EstimatorSpec, DescribedEstimator.
template <typename Estimator>
size_t FindEstimator(const std::vector<Estimator>& estimators, const std::string& label,
                     const std::string& owner) {
  std::vector<std::string> labels;
  for (const Estimator& estimator : estimators) labels.push_back(estimator.label);
  return FindLabel(labels, label, owner);
}

}  // namespace rcme
