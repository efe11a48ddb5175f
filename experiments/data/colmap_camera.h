// The cameras of COLMAP, in a database and in a reconstruction.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "estimator/geometry/lens.h"

namespace rcme {

// COLMAP's pixel (0.5, 0.5) is the centre of the top-left one, here (0, 0) is.
constexpr double kColmapHalfPixel = 0.5;

struct ColmapCamera {
  std::int64_t model = 0;  // COLMAP's number
  std::int64_t width = 0, height = 0;
  std::vector<double> parameters;  // as COLMAP orders them: f or fx fy, cx cy, distortion
};

// How many parameters the model has. Throws InputError that begins with `place`: the model is not supported.
size_t NumColmapParameters(std::int64_t model, const std::string& place);
// The number of a model's name, as cameras.txt has it. Throws InputError as above.
std::int64_t ColmapModelNumber(const std::string& name, const std::string& place);

// A camera by its model's name, in pixels of which (0, 0) is a centre. Throws InputError as below.
Lens MakeNamedLens(const std::string& model, const std::vector<double>& parameters,
                   const std::array<int, 2>& size, const std::string& place);
// "OPENCV w h fx fy cx cy k1 k2 p1 p2" as words: a line of cameras.txt without its id, but for the half
// pixel: here, as in the match files, (0, 0) is the centre of the top-left pixel. Throws as below.
Lens LensFromWords(const std::vector<std::string>& words, const std::string& place);
// The same without the size: "OPENCV fx fy cx cy k1 k2 p1 p2"; width and height are 0.
Lens LensWithoutSizeFromWords(const std::vector<std::string>& words, const std::string& place);

// Its principal point with (0, 0) a pixel's centre. Throws InputError that begins with `place`: another
// number of parameters, a size or a focal length that no camera has.
Lens LensOfColmapCamera(const ColmapCamera& camera, const std::string& place);

}  // namespace rcme
