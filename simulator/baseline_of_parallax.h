#pragma once

#include <functional>
#include <optional>

namespace rcme {

// What a baseline gives: the parallax, or nothing where no scene can be drawn with it.
using ParallaxOfBaseline = std::function<std::optional<double>(double baseline_m)>;

struct BaselineSearch {
  std::optional<double> baseline_m;  // to six digits; nothing: no baseline gives the parallax
  // The greatest parallax that was met.
  double greatest_deg = 0.0;
};

// The least baseline whose parallax is `wanted_deg` within one in a thousand, for a parallax that grows with
// the baseline as long as the scene can be seen at all: steps in proportion, as angles are small, kept
// between a baseline that gives too little and one that gives too much or nothing.
BaselineSearch FindBaseline(const ParallaxOfBaseline& parallax_deg, double wanted_deg);

}  // namespace rcme
