// The outlier laws that outlier_registry lists, one file each.
#pragma once

#include <memory>

#include "simulator/outlier_law.h"

namespace rcme {

// Anywhere in image 2, or near the true point.
std::unique_ptr<OutlierLaw> MakeUniformOutliers();
std::unique_ptr<OutlierLaw> MakeDisplacedOutliers();

// Clusters: key points crowd in a few places of one image, or one patch is taken for another.
std::unique_ptr<OutlierLaw> MakeClusteredInImage1();
std::unique_ptr<OutlierLaw> MakeClusteredInImage2();
std::unique_ptr<OutlierLaw> MakeClusteredInBoth();

// Wrong matches with a geometric cause: another motion, another repetition, another depth.
std::unique_ptr<OutlierLaw> MakeMovingObject();
std::unique_ptr<OutlierLaw> MakeRepeatedTexture();
std::unique_ptr<OutlierLaw> MakeEpipolarOutliers();

// A point of image 1 matched several times, once correctly.
std::unique_ptr<OutlierLaw> MakeOneToManyOutliers();

// A mixture of all of the above.
std::unique_ptr<OutlierLaw> MakeOutlierMixture();

}  // namespace rcme
