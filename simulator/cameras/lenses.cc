#include <utility>

#include "simulator/cameras/camera_models.h"

namespace rcme {
namespace {

// Two equal cameras. A lens adds its coefficients as parameters, in the order of Lens::k.
class LensPair : public CameraModel {
 public:
  explicit LensPair(const Lens& lens) : lens_(lens) {}

  std::vector<Parameter> Parameters() override {
    std::vector<Parameter> all = {
        Parameter::Integer("image_width", &lens_.camera.width, {16, 100'000}, "width of both images, px"),
        Parameter::Integer("image_height", &lens_.camera.height, {16, 100'000}, "height of both images, px"),
        Parameter::Real("focal_px", &lens_.camera.fx, {1.0, 1e6}, "px", "focal length of both cameras")};
    for (const auto& [name, doc] : CoefficientNames())
      all.push_back(Parameter::Real(name, &lens_.k[all.size() - 3], {-10.0, 10.0}, "", doc));
    return all;
  }

  std::pair<SceneCamera, SceneCamera> Make() const override {
    Lens lens = lens_;
    lens.camera.fy = lens.camera.fx;
    lens.camera.cx = 0.5 * (lens.camera.width - 1);
    lens.camera.cy = 0.5 * (lens.camera.height - 1);
    return {SceneCamera(lens), SceneCamera(lens)};
  }

 private:
  std::vector<std::pair<std::string, std::string>> CoefficientNames() const {
    if (lens_.model == LensModel::kRadtan) {
      return {{"lens_k1", "radial coefficient of r^2, OpenCV's k1"},
              {"lens_k2", "radial coefficient of r^4, OpenCV's k2"},
              {"lens_p1", "tangential coefficient, OpenCV's p1"},
              {"lens_p2", "tangential coefficient, OpenCV's p2"},
              {"lens_k3", "radial coefficient of r^6, OpenCV's k3"}};
    }
    return {{"lens_k1", "coefficient of theta^3, OpenCV's k1; theta: angle from the axis"},
            {"lens_k2", "coefficient of theta^5, OpenCV's k2"},
            {"lens_k3", "coefficient of theta^7, OpenCV's k3"},
            {"lens_k4", "coefficient of theta^9, OpenCV's k4"}};
  }

  Lens lens_;
};

Camera MakeSized(int width, int height, double focal_px) {
  return {.fx = focal_px, .fy = focal_px, .width = width, .height = height};
}

}  // namespace

// By default like EuRoC's cameras: 752 x 480, 78 deg across.
std::unique_ptr<CameraModel> MakeRadtan() {
  return std::make_unique<LensPair>(
      Lens{MakeSized(752, 480, 458.0), LensModel::kRadtan, {-0.28, 0.07, 0.0002, 0.00002}});
}

// By default like those of TUM VI: 512 x 512, 150 deg across at the given focal length.
std::unique_ptr<CameraModel> MakeFisheye() {
  return std::make_unique<LensPair>(
      Lens{MakeSized(512, 512, 190.0), LensModel::kFisheye, {0.003, 0.0007, -0.002, 0.0002}});
}

}  // namespace rcme
