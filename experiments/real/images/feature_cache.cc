#include "experiments/real/images/feature_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/core/version.hpp>
#include <type_traits>

#include "experiments/core/files/file_output.h"
#include "stats/fnv1a.h"

namespace rcme {
namespace {

constexpr std::uint32_t kMaxScale = 1000;

std::uint64_t Hash(std::string_view bytes, Fnv1a hash = {}) {
  hash.Add(bytes);
  return hash.value();
}

// The beginning of a file. The key points, the descriptors and a hash of all preceding bytes follow.
struct CacheHeader {
  std::array<char, 16> magic = {'r', 'c', 'm', 'e', ' ', 'f', 'e', 'a',
                                't', 'u', 'r', 'e', 's', ' ', '2', '\n'};
  std::int32_t width = 0, height = 0;
  std::uint32_t num_key_points = 0, num_descriptor_bytes = 0;
  std::uint32_t is_binary = 0, scale = 1;
};
static_assert(std::is_trivially_copyable_v<CacheHeader> && sizeof(CacheHeader) == 40);
static_assert(std::is_trivially_copyable_v<KeyPoint> && sizeof(KeyPoint) == 12);

std::string MakeCacheName(const std::string& image, const DetectorOptions& options) {
  const std::string about = fmt::format("2 {} {} {}{}", CV_VERSION, static_cast<int>(options.detector),
                                        options.max_features, options.refines_corners ? " refined" : "");
  Fnv1a hash_about;
  hash_about.Add(about);
  return fmt::format("{:016x}{:016x}.features", Hash(image), Hash(image, hash_about));
}

}  // namespace

std::string PackFeatures(const ImageFeatures& image) {
  const Features& features = image.features;
  CacheHeader header;
  header.width = image.width;
  header.height = image.height;
  header.num_key_points = static_cast<std::uint32_t>(features.key_points.size());
  header.num_descriptor_bytes = static_cast<std::uint32_t>(features.descriptors.size());
  header.is_binary = features.is_binary;
  header.scale = static_cast<std::uint32_t>(features.scale);
  std::string bytes(reinterpret_cast<const char*>(&header), sizeof(header));
  bytes.append(reinterpret_cast<const char*>(features.key_points.data()),
               features.key_points.size() * sizeof(KeyPoint));
  bytes.append(reinterpret_cast<const char*>(features.descriptors.data()), features.descriptors.size());
  const std::uint64_t hash = Hash(bytes);
  return bytes.append(reinterpret_cast<const char*>(&hash), sizeof(hash));
}

std::optional<ImageFeatures> UnpackFeatures(const std::string& bytes) {
  CacheHeader header;
  const CacheHeader expected;
  std::uint64_t hash = 0;
  if (bytes.size() < sizeof(header) + sizeof(hash)) return std::nullopt;
  const size_t end = bytes.size() - sizeof(hash);
  std::memcpy(&header, bytes.data(), sizeof(header));
  std::memcpy(&hash, bytes.data() + end, sizeof(hash));
  const size_t num_point_bytes = header.num_key_points * sizeof(KeyPoint);
  if (header.magic != expected.magic || header.scale < 1 || header.scale > kMaxScale ||
      end != sizeof(header) + num_point_bytes + header.num_descriptor_bytes ||
      hash != Hash(std::string_view(bytes).substr(0, end)))
    return std::nullopt;
  ImageFeatures image{header.width, header.height, {}};
  const char* at = bytes.data() + sizeof(header);
  image.features.key_points.resize(header.num_key_points);
  if (num_point_bytes > 0) std::memcpy(image.features.key_points.data(), at, num_point_bytes);
  image.features.descriptors.assign(at + num_point_bytes, bytes.data() + end);
  image.features.is_binary = header.is_binary != 0;
  image.features.scale = static_cast<int>(header.scale);
  return image;
}

bool AreFeatures(const ImageFeatures& image, Detector detector) {
  const Features& features = image.features;
  const size_t num_bytes = features.key_points.size() * CountDescriptorBytes(detector);
  if (image.width < 1 || image.height < 1 || features.descriptors.size() != num_bytes) return false;
  if (!features.key_points.empty() && features.is_binary != (detector != Detector::kSift)) return false;
  constexpr float kMarginPx = 1.0f;  // SIFT's shift moves points beyond the image
  return std::ranges::all_of(features.key_points, [&](const KeyPoint& point) {
    return point.x_px >= -kMarginPx && point.x_px <= static_cast<float>(image.width) + kMarginPx &&
           point.y_px >= -kMarginPx && point.y_px <= static_cast<float>(image.height) + kMarginPx &&
           point.size_px > 0.0f && std::isfinite(point.size_px);
  });
}

FeatureCache::FeatureCache(std::string folder) : folder_(std::move(folder)) {
  if (!folder_.empty()) MakeResultFolder(folder_);
}

ImageFeatures FeatureCache::Get(const std::string& path, const DetectorOptions& options) {
  std::string image_bytes = ReadImageBytes(path);
  std::string kept;
  if (!folder_.empty()) {
    kept = (std::filesystem::path(folder_) / MakeCacheName(image_bytes, options)).string();
    std::ifstream file(kept, std::ios::binary);
    const std::optional<ImageFeatures> image =
        UnpackFeatures({std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()});
    if (image && AreFeatures(*image, options.detector)) {
      ++num_found_;
      return *image;
    }
  }
  const GreyImage grey = UnpackImage(std::move(image_bytes), path);
  ImageFeatures image{grey.full_width, grey.full_height, DetectFeatures(grey, options)};
  if (!kept.empty()) WriteFileWhole(kept, PackFeatures(image));
  return image;
}

}  // namespace rcme
