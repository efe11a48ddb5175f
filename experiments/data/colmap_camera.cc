#include "experiments/data/colmap_camera.h"

#include <fmt/format.h>

#include <array>

#include "parameters/input_error.h"
#include "parameters/plain_text.h"

namespace rcme {
namespace {

constexpr std::int64_t kMaxSide = 1'000'000;

// A camera model of COLMAP, and where its parameters lie.
struct ColmapModel {
  std::int64_t number;
  const char* name;
  size_t num_parameters;
  bool has_one_focal_length;
  LensModel lens;
  std::vector<int> coefficient_at;  // per coefficient of ours the parameter, -1: zero
};
const std::vector<ColmapModel>& ColmapModels() {
  static const std::vector<ColmapModel> models = {
      {0, "SIMPLE_PINHOLE", 3, true, LensModel::kPinhole, {}},
      {1, "PINHOLE", 4, false, LensModel::kPinhole, {}},
      {2, "SIMPLE_RADIAL", 4, true, LensModel::kRadtan, {3, -1, -1, -1}},
      {3, "RADIAL", 5, true, LensModel::kRadtan, {3, 4, -1, -1}},
      {4, "OPENCV", 8, false, LensModel::kRadtan, {4, 5, 6, 7}},
      {5, "OPENCV_FISHEYE", 8, false, LensModel::kFisheye, {4, 5, 6, 7}},
      {6, "FULL_OPENCV", 12, false, LensModel::kRadtan, {4, 5, 6, 7, 8, 9, 10, 11}},
      {8, "SIMPLE_RADIAL_FISHEYE", 4, true, LensModel::kFisheye, {3, -1, -1, -1}},
      {9, "RADIAL_FISHEYE", 5, true, LensModel::kFisheye, {3, 4, -1, -1}}};
  return models;
}

[[noreturn]] void RefuseModel(const std::string& model, const std::string& place) {
  throw InputError(
      fmt::format("{}: model {} is not supported; SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV, "
                  "FULL_OPENCV and the fisheye ones of OPENCV and RADIAL are",
                  place, model));
}

const ColmapModel& FindColmapModel(std::int64_t number, const std::string& place) {
  for (const ColmapModel& model : ColmapModels()) {
    if (model.number == number) return model;
  }
  RefuseModel(fmt::format("{}", number), place);
}

}  // namespace

size_t NumColmapParameters(std::int64_t model, const std::string& place) {
  return FindColmapModel(model, place).num_parameters;
}

std::int64_t ColmapModelNumber(const std::string& name, const std::string& place) {
  for (const ColmapModel& model : ColmapModels()) {
    if (model.name == name) return model.number;
  }
  RefuseModel(Quoted(name), place);
}

Lens LensOfColmapCamera(const ColmapCamera& camera, const std::string& place) {
  const ColmapModel& model = FindColmapModel(camera.model, place);
  const std::vector<double>& p = camera.parameters;
  if (p.size() != model.num_parameters)
    throw InputError(
        fmt::format("{}: {} parameters; {} has {}", place, p.size(), model.name, model.num_parameters));
  if (camera.width < 1 || camera.height < 1 || camera.width > kMaxSide || camera.height > kMaxSide)
    throw InputError(fmt::format("{}: an image of {} x {} px; 1 to 1,000,000 are allowed", place,
                                 camera.width, camera.height));
  const size_t c = model.has_one_focal_length ? 1 : 2;
  std::vector<double> coefficients;
  for (const int at : model.coefficient_at) coefficients.push_back(at < 0 ? 0.0 : p[static_cast<size_t>(at)]);
  return MakeLens({p[0], p[c - 1], p[c] - kColmapHalfPixel, p[c + 1] - kColmapHalfPixel,
                   static_cast<int>(camera.width), static_cast<int>(camera.height)},
                  model.lens, coefficients, place);
}

}  // namespace rcme
