#include "estimator/conform/conform_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "parameters/input_error.h"
#include "parameters/plain_text.h"
#include "stats/constants.h"
#include "stats/fnv1a.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kConformFormat = "rcme conform 3";

// JSON has only finite numbers.
Json FactorAsJson(double factor) { return std::isfinite(factor) ? Json(factor) : Json("all motions"); }

Json ModelAsJson(const FeatureModel& model) {
  Json terms = Json::array();
  for (const FeatureModel::Term& term : model.terms) {
    terms.push_back({{"feature", VisibleFeatureNames()[term.feature]},
                     {"centre", term.centre},
                     {"scale", term.scale},
                     {"linear", term.linear},
                     {"square", term.square}});
  }
  return {{"intercept", model.intercept}, {"terms", std::move(terms)}};
}

// Reads the values of an object. Throws std::invalid_argument that names the key if one is wrong.
class ObjectReader {
 public:
  ObjectReader(const Json& json, std::string name) : json_(json), name_(std::move(name)) {
    if (!json.is_object()) Fail("is no object");
  }

  const Json& At(const std::string& key) {
    used_.insert(key);
    const auto found = json_.find(key);
    if (found == json_.end()) Fail(fmt::format("has no key '{}'", key));
    return *found;
  }
  double Number(const std::string& key) {
    const Json& value = At(key);
    if (!value.is_number()) Fail(fmt::format("'{}' is no number", key));
    return value.get<double>();
  }
  // A number between two bounds, both excluded.
  double NumberBetween(const std::string& key, double low, double high) {
    const double value = Number(key);
    if (!(value > low && value < high))
      Fail(fmt::format("'{}' is {:.6g}, not between {:.6g} and {:.6g}", key, value, low, high));
    return value;
  }
  // A failure bound, deg.
  double Angle(const std::string& key) {
    const double value = Number(key);
    if (!(value > 0.0 && value <= 180.0))
      Fail(fmt::format("'{}' is {:.6g}, not above 0 and at most 180 degrees", key, value));
    return value;
  }
  std::int64_t Count(const std::string& key) {
    const Json& value = At(key);
    if (!value.is_number_integer() || value.get<double>() < 0.0 || value.get<double>() > 1e15)
      Fail(fmt::format("'{}' is no count", key));
    return value.get<std::int64_t>();
  }
  std::string Text(const std::string& key) {
    const Json& value = At(key);
    if (!value.is_string()) Fail(fmt::format("'{}' is no text", key));
    return value.get<std::string>();
  }
  bool Flag(const std::string& key) {
    const Json& value = At(key);
    if (!value.is_boolean()) Fail(fmt::format("'{}' is neither true nor false", key));
    return value.get<bool>();
  }
  const Json& List(const std::string& key) {
    const Json& value = At(key);
    if (!value.is_array()) Fail(fmt::format("'{}' is no list", key));
    return value;
  }
  // Throws if the object has a key that was not read.
  void RequireNoOther() const {
    for (const auto& [key, value] : json_.items())
      if (!used_.contains(key)) Fail(fmt::format("has an unknown key {}", Quoted(key)));
  }
  [[noreturn]] void Fail(const std::string& what) const { throw std::invalid_argument(name_ + " " + what); }

 private:
  const Json& json_;
  std::string name_;
  std::set<std::string> used_;
};

double NumberIn(const Json& value, const std::string& name) {
  if (!value.is_number()) throw std::invalid_argument(name + " holds something that is no number");
  return value.get<double>();
}

size_t FeatureNamed(const Json& value) {
  const std::vector<std::string>& names = VisibleFeatureNames();
  const auto found = value.is_string() ? std::ranges::find(names, value.get<std::string>()) : names.end();
  if (found == names.end())
    throw std::invalid_argument(fmt::format("unknown feature; known: {}", fmt::join(names, ", ")));
  return static_cast<size_t>(found - names.begin());
}

FeatureModel ModelFrom(const Json& json, const std::string& name) {
  ObjectReader reader(json, name);
  FeatureModel model;
  model.intercept = reader.Number("intercept");
  for (const Json& entry : reader.List("terms")) {
    ObjectReader term(entry, name + ": a term");
    model.terms.push_back({FeatureNamed(term.At("feature")), term.Number("centre"), term.Number("scale"),
                           term.Number("linear"), term.Number("square")});
    term.RequireNoOther();
  }
  reader.RequireNoOther();
  return model;
}

void ReadEstimator(const Json& json, ConformRule* rule) {
  ObjectReader reader(json, "estimator");
  rule->estimator = reader.Text("name");
  const Json& options = reader.At("options");
  if (!options.is_object()) reader.Fail("'options' is no object");
  for (const auto& [option, value] : options.items()) {
    if (!value.is_string()) reader.Fail("'options' holds something that is no text");
    rule->options.emplace_back(option, value.get<std::string>());
  }
  reader.RequireNoOther();
}

// Each group has a problem, and each problem is an answer or a refusal.
void RequireConsistentCounts(const ConformOrigin& origin) {
  const auto require_at_most = [](std::int64_t count, const char* key, std::int64_t most, const char* what) {
    if (count > most)
      throw std::invalid_argument(
          fmt::format("calibration '{}' is {}, more than {}, which are {}", key, count, what, most));
  };
  if (origin.num_answers < 1) throw std::invalid_argument("calibration 'answers' is 0, not at least 1");
  require_at_most(origin.num_groups, "groups", origin.num_answers + origin.num_refusals,
                  "answers and refusals");
  require_at_most(origin.num_refused_groups, "refused_groups",
                  std::min(origin.num_groups, origin.num_refusals), "groups or refusals");
  if (origin.num_groups < 1) throw std::invalid_argument("calibration 'groups' is 0, not at least 1");
}

// Reads the names of problems: 16 hexadecimal digits each, ascending.
std::vector<std::string> ReadProblems(ObjectReader& reader) {
  std::vector<std::string> problems;
  for (const Json& name : reader.List("problems")) {
    if (!name.is_string()) reader.Fail("'problems' holds something that is no text");
    problems.push_back(name.get<std::string>());
    const bool is_hash = problems.back().size() == 16 &&
                         problems.back().find_first_not_of("0123456789abcdef") == std::string::npos;
    if (!is_hash) reader.Fail("'problems' holds something that is not 16 hexadecimal digits");
  }
  if (problems.empty() || !std::ranges::is_sorted(problems, std::less_equal<>()))
    reader.Fail("'problems' is empty or does not ascend");
  return problems;
}

ConformOrigin OriginFrom(const Json& json) {
  ObjectReader reader(json, "calibration");
  ConformOrigin origin{reader.Text("study"),     ReadProblems(reader),   reader.Count("answers"),
                       reader.Count("refusals"), reader.Count("groups"), reader.Count("refused_groups"),
                       reader.Flag("new_groups")};
  reader.RequireNoOther();
  RequireConsistentCounts(origin);
  return origin;
}

double FactorFrom(const Json& json) {
  if (json == "all motions") return kInfinity;
  const double factor = NumberIn(json, "factors");
  if (!(factor > 0.0 && std::isfinite(factor)))
    throw std::invalid_argument(
        fmt::format("region 'factors' holds {:.6g}, not a number above 0 or \"all motions\"", factor));
  return factor;
}

void ReadRegion(const Json& json, ConformRule* rule) {
  ObjectReader reader(json, "region");
  rule->level = reader.NumberBetween("level", 0.5, 1.0);
  rule->difficulty = ModelFrom(reader.At("difficulty"), "difficulty");
  for (const Json& edge : reader.List("edges")) rule->edges.push_back(NumberIn(edge, "edges"));
  for (const Json& factor : reader.List("factors")) rule->factors.push_back(FactorFrom(factor));
  reader.RequireNoOther();
}

void ReadFailure(const Json& json, ConformRule* rule) {
  ObjectReader reader(json, "failure");
  rule->max_rotation_error_deg = reader.Angle("max_rotation_error_deg");
  rule->max_direction_error_deg = reader.Angle("max_direction_error_deg");
  rule->failure = ModelFrom(reader.At("log_odds"), "log_odds");
  rule->log_odds_intercept = reader.Number("intercept");
  rule->log_odds_slope = reader.Number("slope");
  if (!(rule->log_odds_slope >= 0.0))  // 0: the log-odds carry no information
    reader.Fail(fmt::format("'slope' is {:.6g}, not at least 0", rule->log_odds_slope));
  reader.RequireNoOther();
}

void ReadAcceptRule(const Json& json, ConformRule* rule) {
  ObjectReader reader(json, "accept_rule");
  rule->wrong_and_accepted = reader.NumberBetween("wrong_and_accepted", 0.0, 1.0);
  rule->risk = reader.NumberBetween("risk", 0.0, 1.0);
  if (!reader.At("greatest_log_odds").is_null()) rule->greatest_log_odds = reader.Number("greatest_log_odds");
  reader.RequireNoOther();
}

void ReadFamiliar(const Json& json, ConformRule* rule) {
  ObjectReader reader(json, "familiar");
  for (const Json& name : reader.List("features")) rule->familiar_features.push_back(FeatureNamed(name));
  for (const Json& answer : reader.List("answers")) {
    if (!answer.is_array() || answer.size() != rule->familiar_features.size())
      reader.Fail("holds an answer that has not a number for each feature");
    for (const Json& number : answer)
      rule->familiar.push_back(number.is_null() ? kNaN : NumberIn(number, "familiar"));
  }
  reader.RequireNoOther();
}

// Of the whole file but its checksum.
std::string Checksum(Json json) {
  json.erase("checksum");
  Fnv1a hash;
  hash.Add(json.dump(-1, ' ', false, Json::error_handler_t::replace));
  return fmt::format("{:016x}", hash.value());
}

ConformRule RuleFrom(const Json& json) {
  ObjectReader reader(json, "the file");
  if (const std::string format = reader.Text("format"); format != kConformFormat)
    reader.Fail(fmt::format("is of format {}, not '{}'", Quoted(format), kConformFormat));
  ConformRule rule;
  reader.List("guarantees");
  ReadEstimator(reader.At("estimator"), &rule);
  rule.origin = OriginFrom(reader.At("calibration"));
  ReadRegion(reader.At("region"), &rule);
  ReadFailure(reader.At("failure"), &rule);
  ReadAcceptRule(reader.At("accept_rule"), &rule);
  ReadFamiliar(reader.At("familiar"), &rule);
  const std::string checksum = reader.Text("checksum");
  reader.RequireNoOther();
  const size_t width = rule.familiar_features.size();
  if (width > 0 && rule.familiar.size() / width > static_cast<size_t>(rule.origin.num_groups))
    reader.Fail(fmt::format("has {} familiar answers, more than 'groups', which are {}",
                            rule.familiar.size() / width, rule.origin.num_groups));
  ConformJudge{rule};  // throws for numbers that are no rule
  if (checksum != Checksum(json)) reader.Fail("is damaged, or was changed by hand: its checksum is another one");
  return rule;
}

Json FamiliarAsJson(const ConformRule& rule) {
  const size_t width = rule.familiar_features.size();
  Json names = Json::array(), answers = Json::array();
  for (const size_t feature : rule.familiar_features) names.push_back(VisibleFeatureNames()[feature]);
  for (size_t i = 0; width > 0 && i < rule.familiar.size(); i += width) {
    Json answer = Json::array();
    for (size_t j = 0; j < width; ++j) {
      const double x = rule.familiar[i + j];
      answer.push_back(std::isnan(x) ? Json() : Json(x));
    }
    answers.push_back(std::move(answer));
  }
  return {{"features", std::move(names)}, {"answers", std::move(answers)}};
}

}  // namespace

ConformFile ParseConformFile(std::string_view text, const std::string& path) {
  const auto fail = [&](const std::string& what) {
    return InputError(
        fmt::format("conform: {}: {}; write it with `rcme conform`", Quoted(path), Printable(what, 300)));
  };
  if (text.size() > kMaxConformBytes) throw fail(fmt::format("is longer than {} bytes", kMaxConformBytes));
  Fnv1a hash;
  hash.Add(text);
  try {
    return {RuleFrom(Json::parse(text)), fmt::format("{:016x}", hash.value())};
  } catch (const nlohmann::json::parse_error& error) {
    throw fail(error.byte > text.size() ? fmt::format("is no JSON: it is cut off at byte {}", text.size())
                                        : fmt::format("is no JSON at byte {}", error.byte));
  } catch (const nlohmann::json::exception&) {
    throw fail("is no JSON");
  } catch (const std::invalid_argument& error) {
    throw fail(error.what());
  }
}

ConformFile ReadConformFile(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored))
    throw InputError(
        fmt::format("conform: {} is not a file; give one that `rcme conform` wrote", Quoted(path)));
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(fmt::format("conform: {} cannot be read", Quoted(path)));
  std::string text(kMaxConformBytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (file.bad()) throw InputError(fmt::format("conform: {} cannot be read", Quoted(path)));
  text.resize(static_cast<size_t>(file.gcount()));
  return ParseConformFile(text, path);
}

std::string ConformFileText(const ConformRule& rule, const std::vector<std::string>& guarantees) {
  Json options = Json::object(), factors = Json::array();
  for (const auto& [option, value] : rule.options) options[option] = value;
  for (const double factor : rule.factors) factors.push_back(FactorAsJson(factor));
  const ConformOrigin& origin = rule.origin;
  Json json = {
      {"format", kConformFormat},
      {"guarantees", guarantees},
      {"estimator", {{"name", rule.estimator}, {"options", std::move(options)}}},
      {"calibration",
       {{"study", origin.study},
        {"answers", origin.num_answers},
        {"refusals", origin.num_refusals},
        {"groups", origin.num_groups},
        {"refused_groups", origin.num_refused_groups},
        {"new_groups", origin.new_groups},
        {"problems", origin.problems}}},
      {"region",
       {{"level", rule.level},
        {"difficulty", ModelAsJson(rule.difficulty)},
        {"edges", rule.edges},
        {"factors", std::move(factors)}}},
      {"failure",
       {{"max_rotation_error_deg", rule.max_rotation_error_deg},
        {"max_direction_error_deg", rule.max_direction_error_deg},
        {"log_odds", ModelAsJson(rule.failure)},
        {"intercept", rule.log_odds_intercept},
        {"slope", rule.log_odds_slope}}},
      {"accept_rule",
       {{"wrong_and_accepted", rule.wrong_and_accepted},
        {"risk", rule.risk},
        {"greatest_log_odds", rule.greatest_log_odds ? Json(*rule.greatest_log_odds) : Json()}}},
      {"familiar", FamiliarAsJson(rule)}};
  json["checksum"] = Checksum(json);
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace rcme
