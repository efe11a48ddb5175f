#include "experiments/study/study.h"

#include <fmt/format.h>

#include <algorithm>

#include "parameters/input_error.h"
#include "parameters/settings.h"

namespace rcme {
namespace {

using Rows = std::vector<std::vector<std::string>>;

Rows AllCombinations(const std::vector<Factor>& factors) {
  Rows rows = {{}};
  for (const Factor& factor : factors) {
    Rows longer;
    if (rows.size() * factor.levels.size() > kMaxConditions) {
      throw InputError(fmt::format("factors: more than {} combinations of levels", kMaxConditions));
    }
    for (const std::vector<std::string>& row : rows) {
      for (const std::string& level : factor.levels) {
        longer.push_back(row);
        longer.back().push_back(level);
      }
    }
    rows = std::move(longer);
  }
  return rows;
}

std::string BaseLevel(const Study& study, const std::string& key) {
  std::string base;
  for (const EstimatorSpec& spec : study.estimators) {
    for (const auto& [option, value] : spec.options) {
      if (key == spec.label + "." + option) base = value;
    }
  }
  base = FindSetting(study.data, key).value_or(base);
  if (base.empty()) {
    throw InputError(fmt::format("factors: {}: a one_at_a_time design needs the base value in data", key));
  }
  return base;
}

Rows OneAtATime(const Study& study) {
  std::vector<std::string> base;
  for (const Factor& factor : study.factors) base.push_back(BaseLevel(study, factor.key));
  Rows rows = {base};
  for (size_t f = 0; f < study.factors.size(); ++f) {
    for (const std::string& level : study.factors[f].levels) {
      if (level == base[f]) continue;
      rows.push_back(base);
      rows.back()[f] = level;
    }
  }
  return rows;
}

}  // namespace

std::vector<std::string> JoinLevels(const PopulationDraw& draw, const std::vector<std::string>& of_factors) {
  std::vector<std::string> levels = {fmt::format("{}", draw.number)};
  levels.insert(levels.end(), draw.levels.begin(), draw.levels.end());
  levels.insert(levels.end(), of_factors.begin(), of_factors.end());
  return levels;
}

std::vector<Parameter> Parameters(FailureBounds& bounds) {
  return {Parameter::Real("max_rotation_error_deg", &bounds.max_rotation_error_deg, {0.0, 180.0}, "deg",
                          "greatest rotation error of a success"),
          Parameter::Real("max_direction_error_deg", &bounds.max_direction_error_deg, {0.0, 180.0}, "deg",
                          "greatest direction error of a success")};
}

std::vector<std::pair<std::string, std::string*>> Parts(Ademp& ademp) {
  return {{"aims", &ademp.aims},
          {"data", &ademp.data},
          {"estimands", &ademp.estimands},
          {"methods", &ademp.methods},
          {"performance", &ademp.performance}};
}

std::vector<std::string> FactorNames(const Study& study) {
  std::vector<std::string> names;
  if (study.population) {
    names.push_back(kDrawFactor);
    for (const std::string& key : ListDrawnKeys(*study.population)) names.push_back(key);
  }
  for (const Factor& factor : study.factors) names.push_back(factor.key);
  return names;
}

Rows FactorRows(const Study& study) {
  return study.design == Design::kFullFactorial ? AllCombinations(study.factors) : OneAtATime(study);
}

Rows DesignRows(const Study& study) {
  const Rows of_factors = FactorRows(study);
  if (!study.population) return of_factors;
  Rows rows;
  for (const PopulationDraw& draw : DrawPopulation(study)) {
    if (!draw.outside_of.empty()) continue;
    if (rows.size() + of_factors.size() > kMaxConditions)
      throw InputError(
          fmt::format("conditions: more than {} draws and combinations of levels", kMaxConditions));
    for (const std::vector<std::string>& levels : of_factors) rows.push_back(JoinLevels(draw, levels));
  }
  return rows;
}

bool IsEstimatorOption(const std::string& factor) { return factor.find('.') != std::string::npos; }

Settings CombineSettings(const Study& study, const std::vector<std::string>& levels) {
  Settings settings = study.data;
  const std::vector<std::string> names = FactorNames(study);
  for (size_t f = 0; f < std::min(levels.size(), names.size()); ++f) {
    if (names[f] == kDrawFactor || levels[f] == kNotDrawn || IsEstimatorOption(names[f])) continue;
    settings.emplace_back(names[f], levels[f]);
  }
  return settings;
}

std::vector<EstimatorSpec> ResolveEstimators(const Study& study, const std::vector<std::string>& levels) {
  std::vector<EstimatorSpec> estimators = study.estimators;
  const std::vector<std::string> names = FactorNames(study);
  for (size_t f = 0; f < std::min(levels.size(), names.size()); ++f) {
    if (!IsEstimatorOption(names[f])) continue;
    const size_t dot = names[f].rfind('.');
    for (EstimatorSpec& spec : estimators) {
      if (spec.label == names[f].substr(0, dot)) SetOptions(&spec, {{names[f].substr(dot + 1), levels[f]}});
    }
  }
  return estimators;
}

void RequireFixedOptions(const Study& study, const std::string& who) {
  for (const Factor& factor : study.factors) {
    if (!IsEstimatorOption(factor.key)) continue;
    throw InputError(
        fmt::format("factors: {}: {} takes no options of estimators as factors; choose one with --set "
                    "{}={}",
                    factor.key, who, factor.key, factor.levels.front()));
  }
}

}  // namespace rcme
