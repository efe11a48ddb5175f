#include "experiments/study/estimator_spec.h"

#include <fmt/format.h>

#include <algorithm>

#include "estimator/conform/conform_estimator.h"
#include "estimator/estimator_registry.h"
#include "experiments/study/absent_python.h"
#include "experiments/study/command_permission.h"
#include "parameters/input_error.h"
#include "parameters/suggestion.h"
#include "peers/peer_registry.h"

namespace rcme {

EstimatorSpec DefaultEstimator(const std::string& name) {
  EstimatorSpec spec{name, name, {}, {}};
  SetOptions(&spec, {});
  return spec;
}

bool IsOutside(const std::string& name) {
  return name == "process" || name == "answers" || name == kPythonEstimator;
}

void SetOptions(EstimatorSpec* spec, const Settings& options) {
  const std::unique_ptr<EstimatorModel> model = Configure(*spec);
  const std::vector<Parameter> parameters = model->Parameters();
  for (const auto& [option, value] : options) {
    FindOption(spec->name, parameters, option).SetFromText(value);
  }
  spec->options = ListValues(parameters);
}

Settings AnswersOptions(const std::string& path) {
  return {{"file", path}, {"digest", DigestOfAnswers(path)}};
}

std::optional<EstimatorSpec> FindConformed(const EstimatorSpec& spec) {
  if (spec.name != kConformEstimator) return std::nullopt;
  const std::unique_ptr<EstimatorModel> model = Configure(spec);
  const std::string file = FindParameter(model->Parameters(), "file").Value();
  if (file == "none") return std::nullopt;
  ConformRule rule = ReadConformFile(file).rule;
  if (rule.estimator == kConformEstimator) return std::nullopt;  // Make refuses it
  return EstimatorSpec{spec.label, rule.estimator, rule.options, {}};
}

std::string DescribeEffort(const EstimatorSpec& spec) {
  const std::unique_ptr<EstimatorModel> model = Configure(spec);
  const std::optional<Effort> effort = model->EffortOption();
  if (!effort) return {};
  const std::vector<Parameter> parameters = model->Parameters();
  const std::string limit =
      fmt::format("{} {}", effort->option, FindParameter(parameters, effort->option).Value());
  if (spec.budget_ms) return fmt::format("{:g} ms a call ({})", *spec.budget_ms, limit);
  return effort->has_own_rule ? "own rule, " + limit : limit;
}

void CheckProcessEstimators(const std::vector<EstimatorSpec>& specs) {
  RequireAllowedCommands(specs);
  for (const EstimatorSpec& given : specs) {
    const EstimatorSpec spec = FindConformed(given).value_or(given);
    if (spec.name != "process") continue;
    const std::unique_ptr<EstimatorModel> model = Configure(spec);
    const std::vector<Parameter> parameters = model->Parameters();
    double timeout_s = 0.0;
    ParseReal(FindParameter(parameters, "timeout_s").Value(), &timeout_s);
    RequireCommandAnswers(FindParameter(parameters, "command").Value(), timeout_s);
  }
}

std::unique_ptr<EstimatorModel> Configure(const EstimatorSpec& spec) {
  return ConfigureEstimator(spec.name, spec.options);
}

std::unique_ptr<MotionEstimator> Make(const EstimatorSpec& spec) {
  RequireAllowedCommands({spec});
  return Configure(spec)->Make();
}

size_t FindLabel(const std::vector<std::string>& labels, const std::string& label, const std::string& owner) {
  const auto found = std::ranges::find(labels, label);
  if (found == labels.end())
    throw InputError(fmt::format("{} has no estimator '{}'{}; allowed: {}", owner, label,
                                 DidYouMean(label, labels), fmt::join(labels, ", ")));
  return static_cast<size_t>(found - labels.begin());
}

}  // namespace rcme
