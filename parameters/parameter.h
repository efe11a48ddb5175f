// A named, documented, range-checked view of one field of an options struct.
//
// An options struct stays a plain struct with defaults; a function beside it lists its fields:
//
//   std::vector<Parameter> Parameters(NoiseModel& noise) {
//     return {Parameter::Real("sigma_px", &noise.sigma_px, {1e-9, 100.0}, "px", "noise standard deviation")};
//   }
//
// Study files, `--set key=value`, `rcme list` and the error messages all use this list.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "parameters/settings.h"

namespace rcme {

class Parameter {
 public:
  struct Range {
    double min = -std::numeric_limits<double>::infinity();
    double max = std::numeric_limits<double>::infinity();
  };

  static Parameter Real(std::string name, double* target, Range range, std::string unit, std::string doc);
  // Like Real, but also allows the word `automatic` (stored as NaN).
  static Parameter RealOrWord(std::string name, double* target, Range range, std::string automatic,
                              std::string unit, std::string doc);
  // Like Real, but also allows words, each stored as its number (may be NaN).
  static Parameter RealOrWords(std::string name, double* target, Range range,
                               std::vector<std::pair<std::string, double>> words, std::string unit,
                               std::string doc);
  static Parameter Integer(std::string name, int* target, Range range, std::string doc);
  static Parameter Text(std::string name, std::string* target, std::string allowed, std::string doc);

  template <typename Enum>
  static Parameter Choice(std::string name, Enum* target, std::vector<std::pair<std::string, Enum>> choices,
                          std::string doc);

  // One parameter for fields of several models with a common name: sets all, reads the first. They must be of
  // the same kind and allow the same values.
  static Parameter Together(const std::vector<Parameter>& same);

  const std::string& name() const { return name_; }
  const std::string& unit() const { return unit_; }
  const std::string& doc() const { return doc_; }
  // The allowed values: "a number in [0, 1]", "one of: as_printed, rank_aware".
  const std::string& allowed() const { return allowed_; }

  // Writes the field; throws InputError that names key, value and what is allowed.
  void SetFromText(const std::string& text) const;
  // The current value of the field; SetFromText(Value()) changes nothing.
  std::string Value() const { return get_(); }

 private:
  static std::string ListWords(const std::vector<std::string>& words);

  std::string name_, unit_, doc_, allowed_;
  std::function<bool(const std::string&)> set_;  // false: not allowed, field untouched
  std::function<std::string()> get_;
};

// The parameter called `name`; throws InputError that lists the known names.
const Parameter& FindParameter(const std::vector<Parameter>& parameters, const std::string& name);

// All parameters with their current values.
Settings ListValues(const std::vector<Parameter>& parameters);

// Parses the whole of `text` as a finite number; false if it is not one.
bool ParseReal(const std::string& text, double* value);
bool ParseInteger(const std::string& text, long long* value);

template <typename Enum>
Parameter Parameter::Choice(std::string name, Enum* target, std::vector<std::pair<std::string, Enum>> choices,
                            std::string doc) {
  Parameter parameter;
  parameter.name_ = std::move(name);
  parameter.doc_ = std::move(doc);
  std::vector<std::string> words;
  for (const auto& [word, value] : choices) words.push_back(word);
  parameter.allowed_ = "one of: " + ListWords(words);
  parameter.set_ = [target, choices](const std::string& text) {
    for (const auto& [word, value] : choices) {
      if (word != text) continue;
      *target = value;
      return true;
    }
    return false;
  };
  parameter.get_ = [target, choices] {
    for (const auto& [word, value] : choices) {
      if (value == *target) return word;
    }
    return std::string("unknown");
  };
  return parameter;
}

}  // namespace rcme
