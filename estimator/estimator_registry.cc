#include "estimator/estimator_registry.h"

#include <fmt/format.h>

#include <algorithm>

#include "estimator/estimators/local_ransac.h"
#include "estimator/estimators/m_estimator.h"
#include "estimator/estimators/rcme.h"
#include "estimator/estimators/rcme_calibrated.h"
#include "estimator/estimators/robust_score.h"
#include "estimator/estimators/standard.h"
#include "estimator/model_choice/gate.h"
#include "estimator/robust_covariance/covariance_option.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"
#include "parameters/suggestion.h"

namespace rcme {
namespace {

// Adds the robust covariance and the gate of model choice to the entries that take them.
std::vector<EstimatorEntry> WithCommonOptions(std::vector<EstimatorEntry> entries) {
  for (EstimatorEntry& entry : entries) {
    if (!entry.takes_common_options) continue;
    entry.make = [make = std::move(entry.make), uses_scale = entry.uses_noise_scale] {
      return WithGate(WithRobustCovariance(make(), uses_scale));
    };
  }
  return entries;
}

// All estimators of the project end in a fit that uses the noise scale.
std::vector<EstimatorEntry> UsingNoiseScale(std::vector<EstimatorEntry> entries) {
  for (EstimatorEntry& entry : entries) entry.uses_noise_scale = true;
  return entries;
}

std::vector<EstimatorEntry>& Table() {
  static std::vector<EstimatorEntry> registry = WithCommonOptions(UsingNoiseScale({
      {"standard", "RANSAC by inlier count, Gold Standard refinement", StandardModel},
      {"prcme", "RCME without the model-sample test", [] { return RcmeModel(SampleTest::kOff); }},
      {"rcme", "RCME: model-sample test, inlier set quality test, selection by entropy, refinement",
       [] { return RcmeModel(SampleTest::kOn); }},
      {"rcme_calibrated",
       "RCME that estimates noise, keeps several modes and states a probability of failure",
       RcmeCalibratedModel, /*is_peer=*/false, /*is_audited=*/true, /*uses_noise_scale=*/true},
      {"msac", "RANSAC by truncated squared distances (MSAC)", MsacModel, false, false},
      {"mlesac", "RANSAC by mixture likelihood (MLESAC)", MlesacModel, false, false},
      {"lo_ransac", "RANSAC by inlier count with inner refits (LO-RANSAC)", LoRansacModel, false, false},
      {"cov_ransac", "RANSAC by inlier count with refits within the motion's uncertainty (Cov-RANSAC)",
       CovRansacModel, false, false},
      {"m_estimator", "M-estimation (Huber, Tukey) over all matches from the best MSAC hypothesis",
       MEstimatorModel, false, false},
  }));
  return registry;
}

void CheckOptions(const EstimatorEntry& entry) {
  const std::unique_ptr<EstimatorModel> model = entry.make();
  const std::vector<Parameter> options = model->Parameters();
  for (const Parameter& option : options) {
    if (option.name().empty() || option.name().find_first_of(".=") != std::string::npos ||
        std::ranges::count(options, option.name(), &Parameter::name) > 1) {
      throw InputError(fmt::format("estimator '{}': option {}: the name is empty, taken or holds . or =",
                                   entry.name, Quoted(option.name())));
    }
    try {
      option.SetFromText(option.Value());
    } catch (const InputError& error) {
      throw InputError(fmt::format("estimator '{}': default of option {}", entry.name, error.what()));
    }
  }
}

}  // namespace

const std::vector<EstimatorEntry>& EstimatorRegistry() { return Table(); }

void AddEstimator(EstimatorEntry entry) {
  if (entry.name.empty() || std::ranges::count(Table(), entry.name, &EstimatorEntry::name) > 0) {
    throw InputError(fmt::format("estimator name '{}' is taken or empty", entry.name));
  }
  entry = WithCommonOptions({std::move(entry)}).front();
  CheckOptions(entry);
  Table().push_back(std::move(entry));
}

const EstimatorEntry& FindEstimator(const std::string& name) {
  std::vector<std::string> names;
  for (const EstimatorEntry& entry : EstimatorRegistry()) {
    if (entry.name == name) return entry;
    names.push_back(entry.name);
  }
  throw InputError(fmt::format("unknown estimator {}{}; known: {}", Quoted(name), DidYouMean(name, names),
                               fmt::join(names, ", ")));
}

const Parameter& FindOption(const std::string& estimator, const std::vector<Parameter>& options,
                            const std::string& name) {
  const auto found = std::ranges::find(options, name, &Parameter::name);
  if (found != options.end()) return *found;
  std::vector<std::string> names;
  for (const Parameter& option : options) names.push_back(option.name());
  throw InputError(fmt::format("estimator {} has no option {}{}; its options: {}", estimator, Quoted(name),
                               DidYouMean(name, names),
                               names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

std::unique_ptr<EstimatorModel> ConfigureEstimator(const std::string& name, const Settings& options) {
  std::unique_ptr<EstimatorModel> model = FindEstimator(name).make();
  const std::vector<Parameter> parameters = model->Parameters();
  for (const auto& [option, value] : options) FindOption(name, parameters, option).SetFromText(value);
  return model;
}

std::unique_ptr<MotionEstimator> MakeEstimator(const std::string& name, const Settings& options) {
  return ConfigureEstimator(name, options)->Make();
}

}  // namespace rcme
