// The cameras of COLMAP, in a database or a reconstruction.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "estimator/geometry/lens.h"

namespace rcme {

// In COLMAP the centre of the top-left pixel is (0.5, 0.5), here it is (0, 0).
constexpr double kColmapHalfPixel = 0.5;

struct ColmapCamera {
  std::int64_t model = 0;  // COLMAP's model number
  std::int64_t width = 0, height = 0;
  std::vector<double> parameters;  // in COLMAP's order: f or fx fy, cx cy, distortion
};

// Returns the number of parameters of a model. Throws InputError that begins with `place` if the model is
// not supported.
size_t NumColmapParameters(std::int64_t model, const std::string& place);
// Returns the number of a model from its name in cameras.txt. Throws the same InputError.
std::int64_t ColmapModelNumber(const std::string& name, const std::string& place);

// Makes a camera from the name of its model; pixel (0, 0) is the centre of the top-left one. Throws
// InputError as LensOfColmapCamera does.
Lens MakeNamedLens(const std::string& model, const std::vector<double>& parameters,
                   const std::array<int, 2>& size, const std::string& place);
// Parses the words "OPENCV w h fx fy cx cy k1 k2 p1 p2": a line of cameras.txt without its id, except that
// (0, 0) is the centre of the top-left pixel, as in match files. Throws as LensOfColmapCamera does.
Lens LensFromWords(const std::vector<std::string>& words, const std::string& place);
// The same without the size: "OPENCV fx fy cx cy k1 k2 p1 p2"; width and height become 0.
Lens LensWithoutSizeFromWords(const std::vector<std::string>& words, const std::string& place);

// Converts a camera so that (0, 0) is the centre of the top-left pixel. Throws InputError that begins with
// `place` for a wrong number of parameters, or an impossible size or focal length.
Lens LensOfColmapCamera(const ColmapCamera& camera, const std::string& place);

}  // namespace rcme
