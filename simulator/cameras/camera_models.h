// The camera pairs that camera_registry lists.
#pragma once

#include <memory>

#include "simulator/camera_model.h"

namespace rcme {

// Ideal cameras with the principal point in the middle, both equal or each with its own size and focal
// length; or with all intrinsics of each camera given.
std::unique_ptr<CameraModel> MakePinhole();
std::unique_ptr<CameraModel> MakeTwoPinholes();
std::unique_ptr<CameraModel> MakeOwnIntrinsics();

// Two equal cameras with a lens (estimator/geometry/lens.h) and the principal point in the middle. Their
// images are distorted.
std::unique_ptr<CameraModel> MakeRadtan();
std::unique_ptr<CameraModel> MakeFisheye();

// Published calibrations of real cameras (after rectification or undistortion).
std::unique_ptr<CameraModel> MakeKitti();
std::unique_ptr<CameraModel> MakeEuroc();
std::unique_ptr<CameraModel> MakeOffice();
std::unique_ptr<CameraModel> MakeEurocAndOffice();

}  // namespace rcme
