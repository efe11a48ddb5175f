#include "experiments/data/match_file_cameras.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "estimator/problem_check.h"
#include "experiments/data/colmap_camera.h"
#include "experiments/data/likely_size.h"

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

// Reads the key `camera1` or `camera2`, which excludes the other keys of that camera.
Lens ReadNamedLens(const MatchHeader& header, const std::string& camera_key, const std::string& size_key,
                   const std::string& k_key, const Lens* given) {
  if (given) header.Fail(camera_key, "the file has its own intrinsics; leave out --K and --camera");
  for (const std::string& key : {size_key, k_key}) {
    if (header.Has(key)) header.Fail(key, fmt::format("{} says it already; leave one out", camera_key));
  }
  return LensFromWords(SplitAtBlanks(header.Text(camera_key)), header.Place(camera_key));
}

}  // namespace

Lens ReadLens(const MatchHeader& header, const std::string& number, const Lens* given,
              const std::vector<Correspondence>& matches, Eigen::Vector2d Correspondence::*x_px) {
  const std::string size_key = "size" + number, k_key = "K" + number + "_fx_fy_cx_cy",
                    camera_key = "camera" + number;
  if (header.Has(camera_key)) return ReadNamedLens(header, camera_key, size_key, k_key, given);
  Lens lens;
  Camera& camera = lens.camera;
  if (given) {
    if (header.Has(k_key)) header.Fail(k_key, "the file has its own intrinsics; leave out --K");
    lens = *given;
  }
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

std::vector<CameraDoubt> FindHeaderDoubts(const MatchHeader& header, const MatchFile& file, bool is_given) {
  const auto has_own = [&](const std::string& number) { return header.Has("camera" + number); };
  const auto place = [&](const std::string& number) {
    if (has_own(number)) return header.Place("camera" + number);
    return is_given ? fmt::format("{}: --K", file.path) : header.Place("K" + number + "_fx_fy_cx_cy");
  };
  return FindPairDoubts(file.camera1, file.camera2, file.matches, {place("1"), place("2")},
                        {header.Has("size1") || has_own("1"), header.Has("size2") || has_own("2")});
}

}  // namespace rcme
