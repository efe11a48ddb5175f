#include "simulator/camera_pair.h"

namespace rcme {

Camera CameraPair::Make() const {
  return {focal_px, focal_px, 0.5 * (image_width - 1), 0.5 * (image_height - 1), image_width, image_height};
}

std::vector<Parameter> Parameters(CameraPair& cameras) {
  return {
      Parameter::Integer("image_width", &cameras.image_width, {16, 100'000}, "width of both images, px"),
      Parameter::Integer("image_height", &cameras.image_height, {16, 100'000}, "height of both images, px"),
      Parameter::Real("focal_px", &cameras.focal_px, {1.0, 1e6}, "px", "focal length of both cameras")};
}

}  // namespace rcme
