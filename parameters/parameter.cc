#include "parameters/parameter.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "parameters/input_error.h"
#include "parameters/plain_text.h"
#include "parameters/suggestion.h"

namespace rcme {
namespace {

template <typename Number>
bool ParseWhole(const std::string& text, Number* value) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, *value);
  return error == std::errc() && stop == end;
}

bool Contains(const Parameter::Range& range, double value) {
  return value >= range.min && value <= range.max;
}

std::string DescribeRange(const std::string& kind, const Parameter::Range& range) {
  if (std::isinf(range.min) && std::isinf(range.max)) return kind;
  if (std::isinf(range.max)) return fmt::format("{} >= {}", kind, range.min);
  if (std::isinf(range.min)) return fmt::format("{} <= {}", kind, range.max);
  return fmt::format("{} in [{}, {}]", kind, range.min, range.max);
}

// The words in a text such as "one of: a, b" or "a number in [0, 1] or auto".
std::vector<std::string> WordsIn(const std::string& allowed) {
  constexpr std::string_view kList = "one of: ", kComma = ", ", kOr = " or ";
  const bool is_list = allowed.starts_with(kList);
  const std::string_view separator = is_list ? kComma : kOr;
  std::vector<std::string> words;
  std::string_view rest = allowed;
  rest.remove_prefix(is_list ? kList.size() : std::min(rest.find(kOr), rest.size()));
  while (!rest.empty()) {
    if (rest.starts_with(separator)) rest.remove_prefix(separator.size());
    const size_t end = std::min(rest.find(separator), rest.size());
    words.emplace_back(rest.substr(0, end));
    rest.remove_prefix(end);
  }
  return words;
}

}  // namespace

bool ParseReal(const std::string& text, double* value) {
  double parsed = 0.0;
  if (!ParseWhole(text, &parsed) || !std::isfinite(parsed)) return false;
  *value = parsed + 0.0;  // no -0: equal numbers have equal texts
  return true;
}

bool ParseInteger(const std::string& text, long long* value) { return ParseWhole(text, value); }

Parameter Parameter::Real(std::string name, double* target, Range range, std::string unit, std::string doc) {
  Parameter parameter;
  parameter.name_ = std::move(name);
  parameter.unit_ = std::move(unit);
  parameter.doc_ = std::move(doc);
  parameter.allowed_ = DescribeRange("a number", range);
  parameter.set_ = [target, range](const std::string& text) {
    double value = 0.0;
    if (!ParseReal(text, &value) || !Contains(range, value)) return false;
    *target = value;
    return true;
  };
  parameter.get_ = [target] { return fmt::format("{}", *target); };
  return parameter;
}

Parameter Parameter::RealOrWord(std::string name, double* target, Range range, std::string automatic,
                                std::string unit, std::string doc) {
  return RealOrWords(std::move(name), target, range,
                     {{std::move(automatic), std::numeric_limits<double>::quiet_NaN()}}, std::move(unit),
                     std::move(doc));
}

Parameter Parameter::RealOrWords(std::string name, double* target, Range range,
                                 std::vector<std::pair<std::string, double>> words, std::string unit,
                                 std::string doc) {
  Parameter parameter = Real(std::move(name), target, range, std::move(unit), std::move(doc));
  for (const auto& [word, value] : words) parameter.allowed_ += " or " + word;
  parameter.set_ = [target, words, set_number = parameter.set_](const std::string& text) {
    for (const auto& [word, value] : words) {
      if (text != word) continue;
      *target = value;
      return true;
    }
    return set_number(text);
  };
  parameter.get_ = [target, words] {
    for (const auto& [word, value] : words) {
      if (*target == value || (std::isnan(*target) && std::isnan(value))) return word;
    }
    return fmt::format("{}", *target);
  };
  return parameter;
}

Parameter Parameter::Integer(std::string name, int* target, Range range, std::string doc) {
  Parameter parameter;
  parameter.name_ = std::move(name);
  parameter.doc_ = std::move(doc);
  parameter.allowed_ = DescribeRange("a whole number", range);
  parameter.set_ = [target, range](const std::string& text) {
    long long value = 0;
    if (!ParseInteger(text, &value) || !Contains(range, static_cast<double>(value))) return false;
    if (value > std::numeric_limits<int>::max() || value < std::numeric_limits<int>::min()) return false;
    *target = static_cast<int>(value);
    return true;
  };
  parameter.get_ = [target] { return fmt::format("{}", *target); };
  return parameter;
}

Parameter Parameter::Text(std::string name, std::string* target, std::string allowed, std::string doc) {
  Parameter parameter;
  parameter.name_ = std::move(name);
  parameter.doc_ = std::move(doc);
  parameter.allowed_ = std::move(allowed);
  parameter.set_ = [target](const std::string& text) {
    if (text.empty()) return false;
    *target = text;
    return true;
  };
  parameter.get_ = [target] { return *target; };
  return parameter;
}

Parameter Parameter::Together(const std::vector<Parameter>& same) {
  Parameter parameter = same.front();
  parameter.set_ = [same](const std::string& text) {
    return std::ranges::all_of(same, [&](const Parameter& part) { return part.set_(text); });
  };
  return parameter;
}

void Parameter::SetFromText(const std::string& text) const {
  if (set_(text)) return;
  throw InputError(fmt::format("{}: {} is not allowed{}; give {}", name_, Quoted(text),
                               DidYouMean(text, WordsIn(allowed_)), allowed_));
}

std::string Parameter::ListWords(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, ", "));
}

const Parameter& FindParameter(const std::vector<Parameter>& parameters, const std::string& name) {
  std::vector<std::string> names;
  for (const Parameter& parameter : parameters) {
    if (parameter.name() == name) return parameter;
    names.push_back(parameter.name());
  }
  throw InputError(fmt::format("unknown key {}{}; known keys: {}", Quoted(name), DidYouMean(name, names),
                               fmt::join(names, ", ")));
}

Settings ListValues(const std::vector<Parameter>& parameters) {
  Settings values;
  for (const Parameter& parameter : parameters) values.emplace_back(parameter.name(), parameter.Value());
  return values;
}

}  // namespace rcme
