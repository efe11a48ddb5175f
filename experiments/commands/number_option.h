// Checks of options that are numbers, so that they are read as in files: the whole text, decimal, finite.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <limits>
#include <string>

#include "parameters/parameter.h"

namespace rcme {

// `parse` reads a whole text into a Number; false: the text is not a number. `allowed` says what is, in
// words.
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

// These are for Option::transform: the option's variable gets the number in plain decimal, 10 for 010.
inline CLI::Validator WholeNumberIn(std::int64_t min,
                                    std::int64_t max = std::numeric_limits<std::int64_t>::max()) {
  return NumberValidator<long long>(ParseInteger, min, max,
                                    fmt::format("a whole number in [{}, {}]", min, max));
}

inline CLI::Validator NumberIn(Parameter::Range range = {}) {
  return NumberValidator<double>(ParseReal, range.min, range.max,
                                 Parameter::Real("", nullptr, range, "", "").allowed());
}

}  // namespace rcme
