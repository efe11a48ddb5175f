#include "experiments/study/study.h"

#include <fmt/format.h>

#include "parameters/input_error.h"

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
  for (const auto& [name, value] : study.data) {
    if (name == key) base = value;
  }
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

std::vector<Parameter> Parameters(FailureBounds& bounds) {
  return {Parameter::Real("max_rotation_error_deg", &bounds.max_rotation_error_deg, {0.0, 180.0}, "deg",
                          "a motion with a greater rotation error has failed"),
          Parameter::Real("max_direction_error_deg", &bounds.max_direction_error_deg, {0.0, 180.0}, "deg",
                          "a motion with a greater error of the translation direction has failed")};
}

std::vector<std::pair<std::string, std::string*>> Parts(Ademp& ademp) {
  return {{"aims", &ademp.aims},
          {"data", &ademp.data},
          {"estimands", &ademp.estimands},
          {"methods", &ademp.methods},
          {"performance", &ademp.performance}};
}

std::vector<std::vector<std::string>> DesignRows(const Study& study) {
  return study.design == Design::kFullFactorial ? AllCombinations(study.factors) : OneAtATime(study);
}

Settings SettingsOf(const Study& study, const std::vector<std::string>& levels) {
  Settings settings = study.data;
  for (size_t f = 0; f < levels.size(); ++f) settings.emplace_back(study.factors[f].key, levels[f]);
  return settings;
}

}  // namespace rcme
