#include "experiments/audit/validity/study_samples.h"

#include <fmt/format.h>

#include <set>

#include "experiments/audit/claims/study_cases.h"
#include "experiments/data/make_data.h"
#include "experiments/trial/simulate_draw.h"
#include "parameters/parameter.h"
#include "parameters/settings.h"
#include "simulator/exact_match.h"

namespace rcme {
namespace {

constexpr const char* kSigmaKey = "sigma_px";
constexpr const char* kAssumedSigmaKey = "assumed_sigma_px";

double ReadSettingNumber(const Settings& settings, const std::string& key) {
  double number = std::numeric_limits<double>::quiet_NaN();  // stays NaN for the word "true"
  ParseReal(FindSetting(settings, key).value_or(""), &number);
  return number;
}

// All settings of a condition, at another noise level.
Settings AtSigma(Settings settings, double sigma_px) {
  const double ratio = ReadSettingNumber(settings, kAssumedSigmaKey) / ReadSettingNumber(settings, kSigmaKey);
  for (auto& [key, value] : settings) {
    if (key == kSigmaKey) value = fmt::format("{}", sigma_px);
    if (key == kAssumedSigmaKey && !std::isnan(ratio)) value = fmt::format("{}", ratio * sigma_px);
    if (key == "severity") value = "skipped";
  }
  return settings;
}

// The factors of a map. If the assumed sigma follows the true one, the noise level is left out, because it is
// an axis of its own.
Settings ListMapLevels(const StudyPlan& plan, const Condition& condition, const Settings& settings) {
  const bool is_sigma_true = std::isnan(ReadSettingNumber(settings, kAssumedSigmaKey));
  Settings levels;
  for (size_t f = 0; f < plan.factor_names.size(); ++f) {
    if (plan.factor_names[f] == kSigmaKey && is_sigma_true) continue;
    levels.emplace_back(plan.factor_names[f], condition.levels[f]);
  }
  return levels;
}

std::string DescribeCase(const StudyPlan& plan, const Settings& levels) {
  std::string words;
  for (const auto& [key, value] : levels) {
    words += fmt::format("{}{} = {}", words.empty() ? "" : ", ", key, value);
  }
  return words.empty() ? plan.study.name : words;
}

// The first matches of a case in which all are true: `num_points` for the sample and a fresh one.
MapSample MakeMapSample(const Case& made, int num_points) {
  const auto n = static_cast<size_t>(num_points);
  const TrialData& data = made.data;
  MapSample sample{made.pose_true(), {data.problem, data.problem.matches[n]}, {data.problem, {}}, 0.0};
  sample.observed.problem.matches.resize(n);
  sample.observed.problem.noise_scale.clear();  // the map shows first-order theory for equal noise
  sample.exact.problem.noise_scale.clear();
  sample.exact.problem.matches.clear();
  const auto point = [&](size_t k) { return made.scene.points_in_cam1[data.scene_point[k]]; };
  for (size_t k = 0; k < n; ++k) sample.exact.problem.matches.push_back(PinholeMatch(made.scene, point(k)));
  sample.exact.fresh_match = PinholeMatch(made.scene, point(n));
  sample.parallax_rad = ParallaxRad(made.scene, point(n));
  return sample;
}

MapSampler MakeMapSampler(const Study& study, const Settings& settings, int num_points) {
  const CaseMaker make = CasesFrom(MakeSimulatedData(settings, BaselineTiming::kWithFirstScene));
  const CaseNeeds needs{.num_true_matches = num_points + 1};
  return [study, make, needs, num_points](const StreamName& name) -> std::optional<MapSample> {
    auto simulated = SimulateDraw(study, [&] { return make(name); });
    if (!simulated.made || !WhatIsMissing(*simulated.made, needs).empty()) return std::nullopt;
    KeepTrueMatches(&simulated.made->data);
    return MakeMapSample(*simulated.made, num_points);
  };
}

}  // namespace

std::vector<MapCondition> ListMapConditions(const StudyPlan& plan) {
  RequireCases(plan.study);
  std::vector<MapCondition> conditions;
  std::set<Settings> seen;
  for (const Condition& condition : plan.conditions) {
    const Settings settings = SimulatedSettings(plan, condition);
    const Settings levels = ListMapLevels(plan, condition, settings);
    if (!seen.insert(levels).second) continue;
    conditions.push_back(
        {DescribeCase(plan, levels), [study = plan.study, settings](int num_points, double sigma_px) {
           return MakeMapSampler(study, AtSigma(settings, sigma_px), num_points);
         }});
  }
  return conditions;
}

std::vector<double> ListSigmas(const StudyPlan& plan) {
  std::set<double> sigmas_px;
  for (const Condition& condition : plan.conditions) {
    sigmas_px.insert(ReadSettingNumber(SimulatedSettings(plan, condition), kSigmaKey));
  }
  return {sigmas_px.begin(), sigmas_px.end()};
}

}  // namespace rcme
