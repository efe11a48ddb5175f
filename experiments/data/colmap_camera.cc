#include "experiments/data/colmap_camera.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <span>

#include "parameters/input_error.h"
#include "parameters/parameter.h"
#include "parameters/plain_text.h"
#include "parameters/suggestion.h"

namespace rcme {
namespace {

constexpr std::int64_t kMaxSide = 1'000'000;

// A camera model of COLMAP and the positions of its parameters.
struct ColmapModel {
  std::int64_t number;
  const char* name;
  size_t num_parameters;
  bool has_one_focal_length;
  LensModel lens;
  std::vector<int> coefficient_at;  // parameter of each of our coefficients; -1: zero
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

// Other programs' names of models that COLMAP has.
constexpr const char* kOtherNames =
    "radtan and plumb_bob are OPENCV, equidistant, fisheye and KANNALA_BRANDT OPENCV_FISHEYE";

[[noreturn]] void RefuseModel(const std::string& model, const std::string& place) {
  const std::vector<std::string> names = ListNames(ColmapModels());
  throw InputError(fmt::format("{}: model {} is not supported{}; allowed are {} ({})", place, Quoted(model),
                               DidYouMean(model, names), fmt::join(names, ", "), kOtherNames));
}

const ColmapModel& FindColmapModel(std::int64_t number, const std::string& place) {
  for (const ColmapModel& model : ColmapModels()) {
    if (model.number == number) return model;
  }
  RefuseModel(fmt::format("{}", number), place);
}

void CheckSize(double width, double height, const std::string& place) {
  const auto is_side = [](double px) { return px >= 1.0 && px <= kMaxSide && px == std::floor(px); };
  if (is_side(width) && is_side(height)) return;
  throw InputError(fmt::format("{}: an image of {} x {} px; whole numbers from 1 to 1,000,000 are allowed",
                               place, width, height));
}

// `half_px`: the centre of the top-left pixel in the coordinates of the parameters.
Lens MakeModelLens(const ColmapModel& model, const std::vector<double>& p, const std::array<int, 2>& size,
                   double half_px, const std::string& place) {
  if (p.size() != model.num_parameters)
    throw InputError(
        fmt::format("{}: {} parameters; {} has {}", place, p.size(), model.name, model.num_parameters));
  const size_t c = model.has_one_focal_length ? 1 : 2;
  std::vector<double> coefficients;
  for (const int at : model.coefficient_at) coefficients.push_back(at < 0 ? 0.0 : p[static_cast<size_t>(at)]);
  return MakeLens({p[0], p[c - 1], p[c] - half_px, p[c + 1] - half_px, size[0], size[1]}, model.lens,
                  coefficients, place);
}

std::vector<double> ParseNumbers(std::span<const std::string> words, const std::string& place) {
  std::vector<double> numbers;
  for (const std::string& word : words) {
    double number = 0.0;
    if (!ParseReal(word, &number))
      throw InputError(fmt::format("{}: {} is not a finite number", place, Quoted(word)));
    numbers.push_back(number);
  }
  return numbers;
}

}  // namespace

size_t NumColmapParameters(std::int64_t model, const std::string& place) {
  return FindColmapModel(model, place).num_parameters;
}

std::int64_t ColmapModelNumber(const std::string& name, const std::string& place) {
  for (const ColmapModel& model : ColmapModels()) {
    if (model.name == name) return model.number;
  }
  RefuseModel(name, place);
}

Lens LensOfColmapCamera(const ColmapCamera& camera, const std::string& place) {
  const ColmapModel& model = FindColmapModel(camera.model, place);
  CheckSize(static_cast<double>(camera.width), static_cast<double>(camera.height), place);
  return MakeModelLens(model, camera.parameters,
                       {static_cast<int>(camera.width), static_cast<int>(camera.height)}, kColmapHalfPixel,
                       place);
}

Lens MakeNamedLens(const std::string& model, const std::vector<double>& parameters,
                   const std::array<int, 2>& size, const std::string& place) {
  return MakeModelLens(FindColmapModel(ColmapModelNumber(model, place), place), parameters, size, 0.0, place);
}

Lens LensFromWords(const std::vector<std::string>& words, const std::string& place) {
  if (words.size() < 3)
    throw InputError(
        fmt::format("{}: give a model, width and height in px, and the model's parameters", place));
  const std::vector<double> numbers = ParseNumbers(std::span(words).subspan(1), place);
  CheckSize(numbers[0], numbers[1], place);
  return MakeNamedLens(words.front(), {numbers.begin() + 2, numbers.end()},
                       {static_cast<int>(numbers[0]), static_cast<int>(numbers[1])}, place);
}

Lens LensWithoutSizeFromWords(const std::vector<std::string>& words, const std::string& place) {
  if (words.empty()) RefuseModel("", place);
  return MakeNamedLens(words.front(), ParseNumbers(std::span(words).subspan(1), place), {0, 0}, place);
}

}  // namespace rcme
