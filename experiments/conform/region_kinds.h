// The regions that a report compares, as the estimator states them and as they are made.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiments/conform/cross_validate.h"

namespace rcme {

// A size in degrees is at most this: all motions.
inline constexpr double kWholeSpaceDeg = 180.0;

// A region of each answer: the factor of the stated covariance, or a ball.
struct RegionKind {
  std::string name;
  std::function<bool(const JudgedAnswer&)> covers;
  std::function<double(const JudgedAnswer&)> size_deg;  // geometric mean of the semi-axes
};

// "stated" first and "conformed" last; of a check no others.
std::vector<RegionKind> ListRegionKinds(bool is_check);

}  // namespace rcme
