// The regions that a report compares: the stated one, the conformed one and baselines.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiments/conform/cross_validate.h"

namespace rcme {

// Upper limit of a region's size, deg: the region has all motions.
inline constexpr double kWholeSpaceDeg = 180.0;

// A region around each answer: an ellipsoid of the scaled stated covariance, or a ball.
struct RegionKind {
  std::string name;
  std::function<bool(const JudgedAnswer&)> covers;
  std::function<double(const JudgedAnswer&)> size_deg;  // geometric mean of the semi-axes
};

// "stated" first and "conformed" last. A check has these two only; a calibration has baselines between them.
std::vector<RegionKind> ListRegionKinds(bool is_check);

}  // namespace rcme
