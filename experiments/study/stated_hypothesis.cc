#include "experiments/study/stated_hypothesis.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "experiments/study/study_keys.h"
#include "parameters/parameter.h"
#include "parameters/plain_text.h"
#include "parameters/suggestion.h"

namespace rcme {
namespace {

Parameter DirectionParameter(StatedDirection* direction) {
  return Parameter::Choice<StatedDirection>("direction", direction,
                                            {{"lower", StatedDirection::kLower},
                                             {"higher", StatedDirection::kHigher},
                                             {"not_lower", StatedDirection::kNotLower},
                                             {"not_higher", StatedDirection::kNotHigher}},
                                            "how the quantity compares with that of `against`");
}

bool IsOfAlone(StatedDirection direction) {
  return direction == StatedDirection::kAtLeast || direction == StatedDirection::kAtMost;
}

const char* NameOfBound(StatedDirection direction) {
  switch (direction) {
    case StatedDirection::kAtLeast:
      return "at_least";
    case StatedDirection::kAtMost:
      return "at_most";
    default:
      return "margin";
  }
}

// Throws InputError that lists the allowed names.
std::string OneOfNames(const Place& place, const YAML::Node& node, const std::string& key,
                       const std::vector<std::string>& allowed) {
  std::string text = Line(place, node, key);
  if (std::ranges::count(allowed, text) > 0) return text;
  place.Fail(node, fmt::format("hypotheses: {}: {} is not allowed{}; allowed: {}", key, Quoted(text),
                               DidYouMean(text, allowed), fmt::join(allowed, ", ")));
}

double ReadBound(const Place& place, const YAML::Node& node, const std::string& key) {
  const std::string text = Line(place, node, key);
  double bound = 0.0;
  if (!ParseReal(text, &bound) || !(bound >= 0.0 && bound <= 1.0))
    place.Fail(node,
               fmt::format("hypotheses: {}: {} is not allowed; give a number in [0, 1]", key, Quoted(text)));
  return bound;
}

Settings ReadWhere(const Place& place, const YAML::Node& node, const StatableNames& names) {
  Settings where;
  for (const auto& [key, value] : Entries(place, node, "hypotheses: where", {})) {
    std::vector<std::string> factors;
    for (const auto& [factor, levels] : names.factors) factors.push_back(factor);
    const auto found = std::ranges::find(factors, key);
    if (found == factors.end()) {
      place.Fail(value, fmt::format("hypotheses: where: {} is no factor of the study{}; its factors: {}",
                                    Quoted(key), DidYouMean(key, factors),
                                    factors.empty() ? "none" : fmt::format("{}", fmt::join(factors, ", "))));
    }
    where.emplace_back(key, OneOfNames(place, value, "where: " + key,
                                       names.factors[static_cast<size_t>(found - factors.begin())].second));
  }
  return where;
}

// Checks the keys that an entry needs beside its quantity and estimator.
void CheckIsWhole(const Place& place, const YAML::Node& node) {
  for (const char* key : {"quantity", "estimator"}) {
    if (!node[key]) place.Fail(node, fmt::format("hypotheses: key '{}' is missing", key));
  }
  const int num_claims = (node["at_least"] ? 1 : 0) + (node["at_most"] ? 1 : 0) + (node["direction"] ? 1 : 0);
  if (num_claims != 1)
    place.Fail(node, "hypotheses: give one of: at_least, at_most, direction (with against)");
  if (node["direction"].IsDefined() != node["against"].IsDefined())
    place.Fail(node, "hypotheses: direction and against need each other");
  if (node["margin"] && !node["direction"])
    place.Fail(node["margin"], "hypotheses: margin: needs direction and against");
}

StatedHypothesis ReadHypothesis(const Place& place, const YAML::Node& node, const StatableNames& names) {
  const auto entries = Entries(place, node, "hypotheses", ListStudyKeys("hypothesis"));
  CheckIsWhole(place, node);
  StatedHypothesis hypothesis;
  if (node["at_most"]) hypothesis.direction = StatedDirection::kAtMost;
  for (const auto& [key, value] : entries) {
    if (key == "quantity") hypothesis.quantity = OneOfNames(place, value, key, StatableQuantities());
    if (key == "estimator") hypothesis.estimator = OneOfNames(place, value, key, names.estimators);
    if (key == "against") hypothesis.against = OneOfNames(place, value, key, names.estimators);
    if (key == "direction") {
      place.At(value, [&, value = value] {
        DirectionParameter(&hypothesis.direction).SetFromText(Line(place, value, "direction"));
      });
    }
    if (key == "at_least" || key == "at_most" || key == "margin")
      hypothesis.bound = ReadBound(place, value, key);
    if (key == "where") hypothesis.where = ReadWhere(place, value, names);
  }
  if (hypothesis.against == hypothesis.estimator)
    place.Fail(node, fmt::format("hypotheses: against: {} is the estimator itself; give another",
                                 Quoted(hypothesis.against)));
  const bool needs_margin = hypothesis.direction == StatedDirection::kNotLower ||
                            hypothesis.direction == StatedDirection::kNotHigher;
  if (needs_margin && hypothesis.bound == 0.0)
    place.Fail(node,
               "hypotheses: margin: not_lower and not_higher need one greater than 0: no number of "
               "trials shows that two rates are equal");
  return hypothesis;
}

}  // namespace

const std::vector<std::string>& StatableQuantities() {
  static const std::vector<std::string> names = {
      "success",       "failure",   "failure_or_refusal", "no_candidate",        "other_refusal",
      "kappa_flag",    "auc_5_deg", "auc_10_deg",         "auc_20_deg",          "maa_10_deg",
      "nees_coverage", "brier",     "inlier_brier",       "failure_probability", "failure_of_sure"};
  return names;
}

std::vector<StatedHypothesis> ReadHypotheses(const Place& place, const YAML::Node& node,
                                             const StatableNames& names) {
  if (!node.IsSequence() || node.size() == 0)
    place.Fail(node, "hypotheses: a list of at least one hypothesis is needed");
  if (node.size() > kMaxHypotheses)
    place.Fail(node, fmt::format("hypotheses: {} are too many; at most {} are allowed", node.size(),
                                 kMaxHypotheses));
  std::vector<StatedHypothesis> hypotheses;
  for (const YAML::Node& entry : node) hypotheses.push_back(ReadHypothesis(place, entry, names));
  return hypotheses;
}

void WriteHypotheses(const std::vector<StatedHypothesis>& hypotheses, YAML::Emitter* out) {
  *out << YAML::Block << YAML::BeginSeq;
  for (const StatedHypothesis& hypothesis : hypotheses) {
    StatedDirection direction = hypothesis.direction;
    *out << YAML::Flow << YAML::BeginMap;
    *out << YAML::Key << "quantity" << YAML::Value << hypothesis.quantity;
    *out << YAML::Key << "estimator" << YAML::Value << hypothesis.estimator;
    if (!IsOfAlone(direction)) {
      *out << YAML::Key << "against" << YAML::Value << hypothesis.against;
      *out << YAML::Key << "direction" << YAML::Value << DirectionParameter(&direction).Value();
    }
    *out << YAML::Key << NameOfBound(direction) << YAML::Value << fmt::format("{}", hypothesis.bound);
    if (!hypothesis.where.empty()) {
      *out << YAML::Key << "where" << YAML::Value << YAML::Flow << YAML::BeginMap;
      for (const auto& [factor, level] : hypothesis.where)
        *out << YAML::Key << factor << YAML::Value << level;
      *out << YAML::EndMap;
    }
    *out << YAML::EndMap;
  }
  *out << YAML::EndSeq;
}

std::string Describe(const StatedHypothesis& hypothesis) {
  std::string text = fmt::format("{} of {} is ", hypothesis.quantity, hypothesis.estimator);
  switch (hypothesis.direction) {
    case StatedDirection::kAtLeast:
      text += fmt::format("at least {}", hypothesis.bound);
      break;
    case StatedDirection::kAtMost:
      text += fmt::format("at most {}", hypothesis.bound);
      break;
    case StatedDirection::kLower:
    case StatedDirection::kHigher:
      text += fmt::format("{} than that of {}{}",
                          hypothesis.direction == StatedDirection::kLower ? "lower" : "higher",
                          hypothesis.against,
                          hypothesis.bound > 0.0 ? fmt::format(" by more than {}", hypothesis.bound) : "");
      break;
    case StatedDirection::kNotLower:
    case StatedDirection::kNotHigher:
      text += fmt::format("not {} than that of {} by {} or more",
                          hypothesis.direction == StatedDirection::kNotLower ? "lower" : "higher",
                          hypothesis.against, hypothesis.bound);
      break;
  }
  std::vector<std::string> levels;
  for (const auto& [factor, level] : hypothesis.where) levels.push_back(factor + " = " + level);
  return levels.empty() ? text : fmt::format("{} where {}", text, fmt::join(levels, ", "));
}

}  // namespace rcme
