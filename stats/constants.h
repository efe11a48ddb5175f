// Constants for all rooms.
#pragma once

#include <limits>
#include <numbers>

namespace rcme {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kDegPerRad = 180.0 / std::numbers::pi;
inline constexpr double kRadPerDeg = std::numbers::pi / 180.0;

// Committed results depend on this order of operations in the last bit; kRadPerDeg * deg may differ in it.
constexpr double RadFromDeg(double deg) { return deg * std::numbers::pi / 180.0; }

}  // namespace rcme
