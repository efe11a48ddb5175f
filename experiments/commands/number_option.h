// Validators of options: words, and numbers with the same syntax as in files (whole text, decimal, finite).
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "parameters/parameter.h"
#include "parameters/suggestion.h"

namespace rcme {

// `parse` reads a whole text into a Number and returns false if it is not a number. `allowed` describes the
// allowed values in words.
template <typename Number>
CLI::Validator NumberValidator(bool (*parse)(const std::string&, Number*), Number min, Number max,
                               const std::string& allowed) {
  const auto check = [=](std::string& text) -> std::string {
    Number value{};
    if (!parse(text, &value) || value < min || value > max)
      return fmt::format("'{}' is not allowed; give {}", text, allowed);
    text = fmt::format("{}", value);
    return {};
  };
  return {check, allowed};
}

// The validators of numbers are for Option::transform: they pass the number on in plain decimal, 10 for 010.
inline CLI::Validator WholeNumberIn(std::int64_t min,
                                    std::int64_t max = std::numeric_limits<std::int64_t>::max()) {
  return NumberValidator<long long>(ParseInteger, min, max,
                                    fmt::format("a whole number in [{}, {}]", min, max));
}

// For Option::check: the value must be one of `words`.
inline CLI::Validator MakeChoiceValidator(const std::vector<std::string>& words) {
  const std::string allowed = fmt::format("{}", fmt::join(words, ", "));
  const auto check = [=](const std::string& text) -> std::string {
    if (std::ranges::count(words, text) > 0) return {};
    return fmt::format("'{}' is not allowed{}; give one of: {}", text, DidYouMean(text, words), allowed);
  };
  return {check, "{" + fmt::format("{}", fmt::join(words, ",")) + "}"};
}

inline CLI::Validator NumberIn(Parameter::Range range = {}) {
  return NumberValidator<double>(ParseReal, range.min, range.max,
                                 Parameter::Real("", nullptr, range, "", "").allowed());
}

}  // namespace rcme
