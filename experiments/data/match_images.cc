#include "experiments/data/match_images.h"

#include <fmt/format.h>

#include <opencv2/features2d.hpp>
#include <opencv2/imgcodecs.hpp>

#include "experiments/base/regular_file.h"
#include "experiments/data/image_header.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

constexpr size_t kMaxBytes = size_t{256} << 20;
// SIFT takes some 230 bytes per pixel: 3.9 GB for the largest image.
constexpr std::int64_t kMaxPixels = std::int64_t{4096} * 4096;

// The size that is to be unpacked is known before anything is: a small file may hold a huge image.
void CheckHeader(const std::string& bytes, const std::string& path) {
  const ImageHeader header = ReadImageHeader(bytes);
  if (header.format.empty())
    throw InputError(fmt::format("{}: is not a PNG, JPEG, TIFF, BMP or PNM image; convert it", path));
  if (header.width < 1 || header.height < 1)
    throw InputError(fmt::format("{}: the header of the {} image is damaged", path, header.format));
  if (header.width > kMaxPixels / header.height) {
    throw InputError(
        fmt::format("{}: {} x {} px are too many; at most {} are allowed (such as 4096 x 4096): scale "
                    "the image down, and its K",
                    path, header.width, header.height, kMaxPixels));
  }
}

cv::Mat ReadGrey(const std::string& path) {
  std::string bytes = RegularFile(path, {"image", "an image"}).Read(kMaxBytes + 1);
  if (bytes.size() > kMaxBytes)
    throw InputError(fmt::format("{}: larger than an image can be ({} MiB)", path, kMaxBytes >> 20));
  CheckHeader(bytes, path);
  cv::Mat image;
  try {
    image =
        cv::imdecode(cv::Mat(1, static_cast<int>(bytes.size()), CV_8UC1, bytes.data()), cv::IMREAD_GRAYSCALE);
  } catch (const cv::Exception& error) {
    throw InputError(fmt::format("{}: the image is damaged ({})", path, error.err));
  }
  if (image.empty()) throw InputError(fmt::format("{}: the image is damaged", path));
  return image;
}

Camera CameraOf(const cv::Mat& image, const std::vector<double>& k, const std::string& name) {
  const Camera camera{k.at(0), k.at(1), k.at(2), k.at(3), image.cols, image.rows};
  if (!camera.IsValid()) throw InputError(fmt::format("{}: K is singular; fx and fy must be > 0", name));
  return camera;
}

struct Features {
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat descriptors;
};

Features DetectFeatures(const cv::Mat& image) {
  Features features;
  cv::SIFT::create()->detectAndCompute(image, cv::noArray(), features.keypoints, features.descriptors);
  return features;
}

}  // namespace

MatchFile MatchImages(const MatchImagesOptions& options) {
  const cv::Mat image1 = ReadGrey(options.image1), image2 = ReadGrey(options.image2);
  MatchFile file;
  file.camera1 = CameraOf(image1, options.K1, "--K1");
  file.camera2 = CameraOf(image2, options.K2.empty() ? options.K1 : options.K2, "--K2");
  const Features features1 = DetectFeatures(image1), features2 = DetectFeatures(image2);
  if (features1.keypoints.empty() || features2.keypoints.size() < 2) return file;

  std::vector<std::vector<cv::DMatch>> nearest;
  cv::BFMatcher(cv::NORM_L2).knnMatch(features1.descriptors, features2.descriptors, nearest, 2);
  for (const std::vector<cv::DMatch>& two : nearest) {
    if (two.size() < 2 || two[0].distance >= options.max_ratio * two[1].distance) continue;
    const cv::Point2f& p1 = features1.keypoints[static_cast<size_t>(two[0].queryIdx)].pt;
    const cv::Point2f& p2 = features2.keypoints[static_cast<size_t>(two[0].trainIdx)].pt;
    file.matches.push_back({{p1.x, p1.y}, {p2.x, p2.y}});
  }
  return file;
}

}  // namespace rcme
