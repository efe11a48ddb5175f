// The outlier laws that outlier_registry lists, one file each.
#pragma once

#include <memory>

#include "simulator/outlier_law.h"

namespace rcme {

// Anywhere in image 2, or near the true point.
std::unique_ptr<OutlierLaw> MakeUniformOutliers();
std::unique_ptr<OutlierLaw> MakeDisplacedOutliers();

// Where a detector or a matcher is drawn to a few places of one image, or takes one patch for another.
std::unique_ptr<OutlierLaw> MakeClusteredInImage1();
std::unique_ptr<OutlierLaw> MakeClusteredInImage2();
std::unique_ptr<OutlierLaw> MakeClusteredInBoth();

// Wrong matches with an explanation in space: another motion, another repetition, another depth.
std::unique_ptr<OutlierLaw> MakeMovingObject();
std::unique_ptr<OutlierLaw> MakeRepeatedTexture();
std::unique_ptr<OutlierLaw> MakeEpipolarOutliers();

// A point of image 1 matched several times, once correctly.
std::unique_ptr<OutlierLaw> MakeOneToManyOutliers();

// All of the above in shares.
std::unique_ptr<OutlierLaw> MakeOutlierMixture();

}  // namespace rcme
