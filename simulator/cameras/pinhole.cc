#include "simulator/cameras/camera_models.h"

namespace rcme {
namespace {

struct Pinhole {
  int width = 640, height = 480;  // px
  double focal_px = 700.0;

  Camera Make() const { return {focal_px, focal_px, 0.5 * (width - 1), 0.5 * (height - 1), width, height}; }
};

Parameter WidthParameter(const std::string& name, int* width, const std::string& of) {
  return Parameter::Integer(name, width, {16, 100'000}, "width of " + of + ", px");
}
Parameter HeightParameter(const std::string& name, int* height, const std::string& of) {
  return Parameter::Integer(name, height, {16, 100'000}, "height of " + of + ", px");
}
Parameter FocalParameter(const std::string& name, double* focal_px, const std::string& of) {
  return Parameter::Real(name, focal_px, {1.0, 1e6}, "px", "focal length of " + of);
}

class PinholePair : public CameraModel {
 public:
  std::vector<Parameter> Parameters() override {
    return {WidthParameter("image_width", &camera_.width, "both images"),
            HeightParameter("image_height", &camera_.height, "both images"),
            FocalParameter("focal_px", &camera_.focal_px, "both cameras")};
  }
  std::pair<Camera, Camera> Make() const override { return {camera_.Make(), camera_.Make()}; }

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
  std::pair<Camera, Camera> Make() const override { return {camera1_.Make(), camera2_.Make()}; }

 private:
  Pinhole camera1_, camera2_{1280, 720, 1000.0};
};

}  // namespace

std::unique_ptr<CameraModel> MakePinhole() { return std::make_unique<PinholePair>(); }
std::unique_ptr<CameraModel> MakeTwoPinholes() { return std::make_unique<TwoPinholes>(); }

}  // namespace rcme
