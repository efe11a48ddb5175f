#include "simulator/outlier_registry.h"

#include "simulator/outliers/outlier_laws.h"

namespace rcme {

const std::vector<OutlierEntry>& OutlierRegistry() {
  static const std::vector<OutlierEntry> registry = {
      {"uniform", "the point in image 2 is anywhere", MakeUniformOutliers},
      {"displaced", "the point in image 2 is some px off the true one", MakeDisplacedOutliers},
      {"clustered_image1", "the point in image 1 lies in one of a few clusters", MakeClusteredInImage1},
      {"clustered_image2", "the point in image 2 lies in one of a few clusters", MakeClusteredInImage2},
      {"clustered_both", "patches of image 1 in the wrong place of image 2", MakeClusteredInBoth},
      {"moving_object", "points on an object with its own rigid motion", MakeMovingObject},
      {"repeated_texture", "the same place on another repetition of a pattern", MakeRepeatedTexture},
      {"epipolar", "on the true epipolar line, hence undetectable", MakeEpipolarOutliers},
      {"one_to_many", "truly matched points of image 1, matched once more", MakeOneToManyOutliers},
      {"mixture", "all others, in exact shares", MakeOutlierMixture},
  };
  return registry;
}

}  // namespace rcme
