// Whether intrinsics can be those of the images: K of the image in another size, numbers in another order,
// units that are not pixels, an image that was turned. Half of K costs 6 degrees of rotation, and no test of
// the motion sees it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "estimator/geometry/camera.h"
#include "estimator/geometry/correspondence.h"

namespace rcme {

struct CameraDoubt {
  std::string place;  // of K: a file with line and key, or an option
  std::string what;   // is suspicious, and what to do
};

// What is suspicious about K in an image of this size; mostly nothing. Throws InputError that begins with
// `place` where K is wrong beyond doubt: the principal point lies outside of the image, a corner is seen at
// more than 89.4 degrees from the axis (K is not in px), or pixels are far from square and the numbers fit
// the image in another order. The cameras of KITTI, EuRoC, TUM, ETH3D, ScanNet, DTU and Waymo pass, as do
// those of phones.
std::vector<CameraDoubt> FindCameraDoubts(const Camera& camera, const std::string& place);

// What is suspicious about K beside the key points of its image, looking at all but a twentieth of them;
// nothing of fewer than 50. `is_size_known`: the camera's width and height are the image's. Else the points
// stand for them.
std::vector<CameraDoubt> FindKeyPointDoubts(const Camera& camera, const std::vector<Correspondence>& matches,
                                            Eigen::Vector2d Correspondence::*x_px, bool is_size_known,
                                            const std::string& place);

// Both, of both images of a pair; what holds for both is said once.
std::vector<CameraDoubt> FindPairDoubts(const Camera& camera1, const Camera& camera2,
                                        const std::vector<Correspondence>& matches,
                                        const std::array<std::string, 2>& places,
                                        const std::array<bool, 2>& are_sizes_known = {true, true});

// The doubts about many files, each said once.
class CameraWarnings {
 public:
  void Add(const std::vector<CameraDoubt>& doubts);
  // "warning: PLACE and 12 more: what", in the order of their first places' coming.
  void Print() const;

 private:
  struct Warning {
    CameraDoubt first;
    int count = 0;
  };
  std::vector<Warning> warnings_;
};

}  // namespace rcme
