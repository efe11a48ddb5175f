#include <cmath>
#include <limits>

#include "simulator/cameras/camera_models.h"

namespace rcme {
namespace {

struct Pinhole {
  int width = 640, height = 480;  // px
  double focal_px = 700.0;

  Camera Make() const { return {focal_px, focal_px, 0.5 * (width - 1), 0.5 * (height - 1), width, height}; }
};

Parameter WidthParameter(const std::string& name, int* width, const std::string& owner) {
  return Parameter::Integer(name, width, {16, 100'000}, "width of " + owner + ", px");
}
Parameter HeightParameter(const std::string& name, int* height, const std::string& owner) {
  return Parameter::Integer(name, height, {16, 100'000}, "height of " + owner + ", px");
}
Parameter FocalParameter(const std::string& name, double* focal_px, const std::string& owner) {
  return Parameter::Real(name, focal_px, {1.0, 1e6}, "px", "focal length of " + owner);
}

class PinholePair : public CameraModel {
 public:
  std::vector<Parameter> Parameters() override {
    return {WidthParameter("image_width", &camera_.width, "both images"),
            HeightParameter("image_height", &camera_.height, "both images"),
            FocalParameter("focal_px", &camera_.focal_px, "both cameras")};
  }
  std::pair<SceneCamera, SceneCamera> Make() const override { return {camera_.Make(), camera_.Make()}; }

 private:
  Pinhole camera_;
};

class TwoPinholes : public CameraModel {
 public:
  std::vector<Parameter> Parameters() override {
    return {WidthParameter("image1_width", &camera1_.width, "image 1"),
            HeightParameter("image1_height", &camera1_.height, "image 1"),
            FocalParameter("focal1_px", &camera1_.focal_px, "camera 1"),
            WidthParameter("image2_width", &camera2_.width, "image 2"),
            HeightParameter("image2_height", &camera2_.height, "image 2"),
            FocalParameter("focal2_px", &camera2_.focal_px, "camera 2")};
  }
  std::pair<SceneCamera, SceneCamera> Make() const override { return {camera1_.Make(), camera2_.Make()}; }

 private:
  Pinhole camera1_, camera2_{1280, 720, 1000.0};
};

constexpr double kMiddle = std::numeric_limits<double>::quiet_NaN();  // of the image

// All intrinsics of one camera.
struct Intrinsics {
  int width = 640, height = 480;        // px
  double fx_px = 700.0, fy_px = 700.0;  // focal lengths
  double cx_px = kMiddle, cy_px = kMiddle;

  // The parameters, with the number of the camera in their names.
  std::vector<Parameter> Parameters(const std::string& number) {
    const std::string camera = "camera " + number, middle = "middle";
    const Parameter::Range anywhere{-1e5, 1e5};
    return {WidthParameter("image" + number + "_width", &width, "image " + number),
            HeightParameter("image" + number + "_height", &height, "image " + number),
            FocalParameter("fx" + number + "_px", &fx_px, camera + " in x"),
            FocalParameter("fy" + number + "_px", &fy_px, camera + " in y"),
            Parameter::RealOrWord("cx" + number + "_px", &cx_px, anywhere, middle, "px",
                                  "x of the principal point of " + camera),
            Parameter::RealOrWord("cy" + number + "_px", &cy_px, anywhere, middle, "px",
                                  "y of the principal point of " + camera)};
  }
  Camera Make() const {
    return {fx_px,
            fy_px,
            std::isnan(cx_px) ? 0.5 * (width - 1) : cx_px,
            std::isnan(cy_px) ? 0.5 * (height - 1) : cy_px,
            width,
            height};
  }
};

class OwnIntrinsics : public CameraModel {
 public:
  std::vector<Parameter> Parameters() override {
    std::vector<Parameter> all = camera1_.Parameters("1");
    const std::vector<Parameter> more = camera2_.Parameters("2");
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  std::pair<SceneCamera, SceneCamera> Make() const override { return {camera1_.Make(), camera2_.Make()}; }

 private:
  Intrinsics camera1_, camera2_;
};

}  // namespace

std::unique_ptr<CameraModel> MakePinhole() { return std::make_unique<PinholePair>(); }
std::unique_ptr<CameraModel> MakeTwoPinholes() { return std::make_unique<TwoPinholes>(); }
std::unique_ptr<CameraModel> MakeOwnIntrinsics() { return std::make_unique<OwnIntrinsics>(); }

}  // namespace rcme
