// Checks whether intrinsics can be those of the images: K may be of the image in another size, have its
// numbers in another order or in other units than px, or be of an image that was rotated. Half of K costs 6
// degrees of rotation, and no test of the motion detects it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "estimator/geometry/camera.h"
#include "estimator/geometry/correspondence.h"
#include "estimator/geometry/lens.h"
#include "estimator/motion_problem.h"
#include "experiments/data/input_doubt.h"

namespace rcme {

// Returns what is suspicious about K for an image of this size; usually nothing. Throws InputError that
// begins with `place` if K is certainly wrong: the principal point is outside the image, a corner is more
// than 89.4 degrees off the axis (K is not in px), or pixels are far from square and the numbers fit the
// image in another order. The cameras of KITTI, EuRoC, TUM, ETH3D, ScanNet, DTU, Waymo and phones pass. A
// fisheye image may show more than a pinhole one, so nothing is said of its corners, here and below.
std::vector<InputDoubt> FindCameraDoubts(const Camera& camera, const std::string& place,
                                         LensModel model = LensModel::kPinhole);

// Returns what is suspicious about K given the key points of its image, all but a twentieth of them; nothing
// for fewer than 10. `is_size_known`: the camera has the width and height of the image; otherwise twice
// the principal point and the points are used instead.
std::vector<InputDoubt> FindKeyPointDoubts(const Camera& camera, const std::vector<Correspondence>& matches,
                                           Eigen::Vector2d Correspondence::*x_px, bool is_size_known,
                                           const std::string& place, LensModel model = LensModel::kPinhole);

// Both checks for both images of a pair; equal findings are reported once. Key points that lie outside of the
// stated size and fit K make the size doubtful, not K. Key points that are all within 5 px of (0, 0) make
// themselves doubtful, and nothing else is reported.
std::vector<InputDoubt> FindPairDoubts(const Camera& camera1, const Camera& camera2,
                                       const std::vector<Correspondence>& matches,
                                       const std::array<std::string, 2>& places,
                                       const std::array<bool, 2>& are_sizes_known = {true, true},
                                       const std::array<LensModel, 2>& models = {});

// Estimates the size of an image from the camera's intrinsics and some points: width and height in px. It is
// twice the principal point, or more if that does not contain all points. `x_px` selects the point in this
// image.
std::array<int, 2> LikelySize(const Camera& camera, const std::vector<Correspondence>& matches,
                              Eigen::Vector2d Correspondence::*x_px);

inline constexpr double kMaxImageLength = 1e6;  // px

}  // namespace rcme
