#pragma once

#include <array>

#include "estimator/geometry/correspondence.h"

namespace rcme {

// The four coordinates of a match in the order of the paper's X = [x1; x2].
inline std::array<double*, 4> Coordinates(Correspondence& match) {
  return {&match.x1_px.x(), &match.x1_px.y(), &match.x2_px.x(), &match.x2_px.y()};
}

}  // namespace rcme
