#include "simulator/outlier_registry.h"

#include "simulator/outliers/outlier_laws.h"

namespace rcme {

const std::vector<OutlierEntry>& OutlierRegistry() {
  static const std::vector<OutlierEntry> registry = {
      {"uniform", "the point in image 2 is anywhere", MakeUniformOutliers},
      {"displaced", "the point in image 2 is some pixels off the true one", MakeDisplacedOutliers},
      {"clustered_image1", "points from a few clusters in image 1, matched with anything in image 2",
       MakeClusteredInImage1},
      {"clustered_image2", "the point in image 2 lies in one of a few clusters", MakeClusteredInImage2},
      {"clustered_both",
       "patches of image 1 that appear in the wrong place of image 2: they agree with each other",
       MakeClusteredInBoth},
      {"moving_object", "points on an object with a rigid motion of its own", MakeMovingObject},
      {"repeated_texture", "the same place on another repetition of a pattern in the scene",
       MakeRepeatedTexture},
      {"epipolar", "on the true epipolar line: no epipolar test can detect them", MakeEpipolarOutliers},
      {"one_to_many", "points of image 1 that have a true match already, matched once more",
       MakeOneToManyOutliers},
      {"mixture", "of all the others, in exact shares", MakeOutlierMixture},
  };
  return registry;
}

}  // namespace rcme
