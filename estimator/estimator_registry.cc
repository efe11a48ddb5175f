#include "estimator/estimator_registry.h"

#include <fmt/format.h>

#include "estimator/estimators/rcme.h"
#include "estimator/estimators/standard.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

std::vector<EstimatorEntry>& Table() {
  static std::vector<EstimatorEntry> registry = {
      {"standard", "RANSAC by inlier count, then Gold Standard refinement",
       [](const RansacOptions& o) { return MakeStandard(o); }},
      {"prcme", "RCME without the test of the model against its sample",
       [](const RansacOptions& o) { return MakeRcme(o, SampleTest::kOff); }},
      {"rcme", "RCME: model-sample test, inlier set quality test, selection by entropy, refinement",
       [](const RansacOptions& o) { return MakeRcme(o, SampleTest::kOn); }},
  };
  return registry;
}

}  // namespace

const std::vector<EstimatorEntry>& EstimatorRegistry() { return Table(); }

void AddEstimator(EstimatorEntry entry) {
  for (const EstimatorEntry& known : Table()) {
    if (entry.name.empty() || known.name == entry.name) {
      throw InputError(fmt::format("estimator name '{}' is taken or empty", entry.name));
    }
  }
  Table().push_back(std::move(entry));
}

const EstimatorEntry& FindEstimator(const std::string& name) {
  std::vector<std::string> names;
  for (const EstimatorEntry& entry : EstimatorRegistry()) {
    if (entry.name == name) return entry;
    names.push_back(entry.name);
  }
  throw InputError(fmt::format("unknown estimator '{}'; known: {}", name, fmt::join(names, ", ")));
}

}  // namespace rcme
