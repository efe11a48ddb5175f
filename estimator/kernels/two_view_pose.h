#pragma once

#include "estimator/geometry/pose.h"

namespace rcme {

// A RelativePose as plain numbers, R row by row.
struct TwoViewPose {
  double R[9], t[3];

  explicit TwoViewPose(const RelativePose& pose) {
    for (int i = 0; i < 9; ++i) R[i] = pose.R(i / 3, i % 3);
    for (int i = 0; i < 3; ++i) t[i] = pose.t(i);
  }
};

}  // namespace rcme
