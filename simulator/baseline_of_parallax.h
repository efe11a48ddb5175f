#pragma once

#include <functional>
#include <optional>

namespace rcme {

// The parallax (deg) that a baseline gives; nullopt if no scene can be drawn with it.
using ParallaxOfBaseline = std::function<std::optional<double>(double baseline_m)>;

struct BaselineSearch {
  std::optional<double> baseline_m;  // to six digits; nullopt: no baseline gives the parallax
  // The greatest parallax found during the search.
  double greatest_deg = 0.0;
};

// The least baseline whose parallax is `wanted_deg` to within 0.1 %. The parallax must grow with the baseline
// as long as scenes can be drawn. Each step changes the baseline in proportion, as for small angles, kept
// between a baseline of too little parallax and one of too much or without a scene.
BaselineSearch FindBaseline(const ParallaxOfBaseline& parallax_deg, double wanted_deg);

}  // namespace rcme
