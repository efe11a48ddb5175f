#include "experiments/data/match_file_cameras.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "experiments/data/camera_plausibility.h"
#include "experiments/data/colmap_camera.h"

namespace rcme {
namespace {

std::array<int, 2> ReadSize(const MatchHeader& header, const std::string& key) {
  const std::vector<double> size = header.Numbers(key, 2);
  for (const double length : size) {
    if (length >= 1.0 && length <= kMaxImageLength && length == std::floor(length)) continue;
    header.Fail(key, "width and height must be whole numbers in [1, 1e6] px");
  }
  return {static_cast<int>(size[0]), static_cast<int>(size[1])};
}

// Throws InputError if an option gives the intrinsics that the header has under this key.
void RefuseGiven(const MatchHeader& header, const std::string& key, const GivenCameras& given) {
  if (given && header.Has(key))
    header.Fail(key, "the file has its own intrinsics; leave out " + given->option);
}

// Reads the key `camera1` or `camera2`, which excludes the other keys of that camera.
Lens ReadNamedLens(const MatchHeader& header, const std::string& camera_key, const std::string& size_key,
                   const std::string& k_key) {
  for (const std::string& key : {size_key, k_key}) {
    if (header.Has(key)) header.Fail(key, fmt::format("{} says it already; leave one out", camera_key));
  }
  return LensFromWords(SplitAtBlanks(header.Text(camera_key)), header.Place(camera_key));
}

}  // namespace

Lens ReadLens(const MatchHeader& header, int number, const GivenCameras& given,
              const std::vector<Correspondence>& matches) {
  const std::string size_key = fmt::format("size{}", number), k_key = fmt::format("K{}_fx_fy_cx_cy", number),
                    camera_key = fmt::format("camera{}", number);
  RefuseGiven(header, camera_key, given);
  if (header.Has(camera_key)) return ReadNamedLens(header, camera_key, size_key, k_key);
  RefuseGiven(header, k_key, given);
  Lens lens;
  Camera& camera = lens.camera;
  if (given) lens = number == 1 ? given->lenses.front() : given->lenses.back();
  const auto x_px = number == 1 ? &Correspondence::x1_px : &Correspondence::x2_px;
  const std::array<int, 2> size =
      given && !header.Has(size_key) ? LikelySize(camera, matches, x_px) : ReadSize(header, size_key);
  if (!given) {
    const std::vector<double> k = header.Numbers(k_key, 4);
    camera = {k[0], k[1], k[2], k[3]};
  }
  camera.width = size[0];
  camera.height = size[1];
  if (!given && !camera.IsValid()) header.Fail(k_key, "K is singular or mirrored; fx and fy must be > 0");
  return lens;
}

std::vector<InputDoubt> FindHeaderDoubts(const MatchHeader& header, const MatchFile& file,
                                         const std::array<LensModel, 2>& models, const GivenCameras& given) {
  const auto has_own = [&](const std::string& number) { return header.Has("camera" + number); };
  const auto place = [&](const std::string& number) {
    if (has_own(number)) return header.Place("camera" + number);
    return given ? fmt::format("{}: {}", file.path, given->option)
                 : header.Place("K" + number + "_fx_fy_cx_cy");
  };
  return FindPairDoubts(file.camera1, file.camera2, file.matches, {place("1"), place("2")},
                        {header.Has("size1") || has_own("1"), header.Has("size2") || has_own("2")}, models);
}

}  // namespace rcme
