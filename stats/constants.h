// Numbers that every room needs.
#pragma once

#include <limits>
#include <numbers>

namespace rcme {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kDegPerRad = 180.0 / std::numbers::pi;
inline constexpr double kRadPerDeg = std::numbers::pi / 180.0;

// In this order of operations, whose last bit committed results depend on: kRadPerDeg * deg may differ in it.
constexpr double RadFromDeg(double deg) { return deg * std::numbers::pi / 180.0; }

}  // namespace rcme
