#include "experiments/real/images/features.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "parameters/input_error.h"

namespace rcme {
namespace {

constexpr int kOrbFeatures = 2000;
constexpr float kSiftShiftPx = 0.25f;

cv::Ptr<cv::Feature2D> Make(const DetectorOptions& options) {
  switch (options.detector) {
    case Detector::kSift:
      return cv::SIFT::create(options.max_features);
    case Detector::kOrb:
      return cv::ORB::create(options.max_features > 0 ? options.max_features : kOrbFeatures);
    case Detector::kAkaze:
      break;
  }
  return cv::AKAZE::create();
}

// The size of key points at a detector's finest scale. SIFT: sigma 1.6 2^(1/3) of the doubled image, as a
// diameter; ORB: its patch; AKAZE: first sigma 1.6 times its factor of 1.5, as a diameter.
double FinestSize(Detector detector) {
  switch (detector) {
    case Detector::kSift:
      return 1.6 * 1.2599210498948732;
    case Detector::kOrb:
      return 31.0;
    case Detector::kAkaze:
      break;
  }
  return 4.8;
}

// See DetectorOptions::refines_corners. Descriptors stay those of the places where ORB found the points.
void RefineCorners(const cv::Mat& pixels, std::vector<cv::KeyPoint>* key_points) {
  constexpr int kHalfWindow = 5, kCoarsestOctave = 1, kMaxRounds = 40;
  constexpr float kMaxMovePx = 2.0f;
  constexpr double kLeastMovePx = 1e-3;
  std::vector<size_t> fine;
  std::vector<cv::Point2f> places;
  for (size_t i = 0; i < key_points->size(); ++i) {
    if ((*key_points)[i].octave > kCoarsestOctave) continue;
    fine.push_back(i);
    places.push_back((*key_points)[i].pt);
  }
  if (fine.empty()) return;
  cv::cornerSubPix(pixels, places, {kHalfWindow, kHalfWindow}, {-1, -1},
                   {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, kMaxRounds, kLeastMovePx});
  for (size_t k = 0; k < fine.size(); ++k) {
    cv::Point2f& place = (*key_points)[fine[k]].pt;
    const cv::Point2f move = places[k] - place;
    if (std::hypot(move.x, move.y) <= kMaxMovePx) place = places[k];
  }
}

// Returns the descriptors as a matrix with a row per key point, which shares their memory.
cv::Mat MakeDescriptorMatrix(const Features& features) {
  const int num_rows = static_cast<int>(features.key_points.size());
  const int num_bytes = static_cast<int>(features.descriptors.size()) / num_rows;
  auto* bytes = const_cast<std::uint8_t*>(features.descriptors.data());
  return features.is_binary ? cv::Mat(num_rows, num_bytes, CV_8UC1, bytes)
                            : cv::Mat(num_rows, num_bytes / static_cast<int>(sizeof(float)), CV_32FC1, bytes);
}

// Returns the ratio for the two nearest. If both have distance 0, neither is preferred: 1.
float RatioOfDistances(const std::vector<cv::DMatch>& two) {
  return two[1].distance > 0.0f ? two[0].distance / two[1].distance : 1.0f;
}

// Returns the nearest key point of image 2 for each of image 1 that passes the ratio test.
std::vector<FeatureMatch> MatchNearest(const cv::Mat& rows1, const cv::Mat& rows2, bool is_binary,
                                       double max_ratio) {
  std::vector<std::vector<cv::DMatch>> nearest;
  cv::BFMatcher(is_binary ? cv::NORM_HAMMING : cv::NORM_L2).knnMatch(rows1, rows2, nearest, 2);
  std::vector<FeatureMatch> matches;
  for (const std::vector<cv::DMatch>& two : nearest) {
    if (two.size() < 2 || (max_ratio < 1.0 && two[0].distance >= max_ratio * two[1].distance)) continue;
    matches.push_back({static_cast<std::uint32_t>(two[0].queryIdx),
                       static_cast<std::uint32_t>(two[0].trainIdx), RatioOfDistances(two)});
  }
  return matches;
}

// Removes matches whose key point of image 2 has a nearer one in image 1.
void KeepMutual(const cv::Mat& rows1, const cv::Mat& rows2, bool is_binary,
                std::vector<FeatureMatch>* matches) {
  std::vector<cv::DMatch> back;
  cv::BFMatcher(is_binary ? cv::NORM_HAMMING : cv::NORM_L2).match(rows2, rows1, back);
  std::erase_if(*matches, [&](const FeatureMatch& match) {
    return static_cast<std::uint32_t>(back[match.at2].trainIdx) != match.at1;
  });
}

// Keeps the first match at each place of an image. SIFT detects a point with two orientations twice, at the
// same place.
void KeepOnePerPlace(const std::vector<KeyPoint>& key_points, std::uint32_t FeatureMatch::*at,
                     std::vector<FeatureMatch>* matches) {
  std::map<std::pair<float, float>, int> num_at;
  std::erase_if(*matches, [&](const FeatureMatch& match) {
    const KeyPoint& point = key_points[match.*at];
    return num_at[{point.x_px, point.y_px}]++ > 0;
  });
}

}  // namespace

const std::vector<std::pair<std::string, Detector>>& DetectorNames() {
  static const std::vector<std::pair<std::string, Detector>> names = {
      {"sift", Detector::kSift}, {"orb", Detector::kOrb}, {"akaze", Detector::kAkaze}};
  return names;
}

size_t CountDescriptorBytes(Detector detector) {
  switch (detector) {
    case Detector::kSift:
      return 128 * sizeof(float);
    case Detector::kOrb:
      return 32;
    case Detector::kAkaze:
      break;
  }
  return 61;  // 486 bits
}

Features DetectFeatures(const GreyImage& image, const DetectorOptions& options) {
  if (options.refines_corners && options.detector != Detector::kOrb)
    throw InputError("--subpixel: only orb places key points at whole pixels; give --detector orb with it");
  const cv::Mat pixels(image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.grey.data()));
  std::vector<cv::KeyPoint> key_points;
  cv::Mat descriptors;
  Make(options)->detectAndCompute(pixels, cv::noArray(), key_points, descriptors);
  if (options.refines_corners) RefineCorners(pixels, &key_points);
  std::vector<int> order(key_points.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  if (options.max_features > 0 && order.size() > static_cast<size_t>(options.max_features)) {
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
      return key_points[static_cast<size_t>(a)].response > key_points[static_cast<size_t>(b)].response;
    });
    order.resize(static_cast<size_t>(options.max_features));
    std::sort(order.begin(), order.end());
  }
  const float shift = options.detector == Detector::kSift ? kSiftShiftPx : 0.0f;
  Features features;
  features.is_binary = descriptors.depth() == CV_8U;
  features.scale = image.scale;
  const float scale = static_cast<float>(image.scale), middle = 0.5f * (scale - 1.0f);
  for (const int i : order) {
    const cv::KeyPoint& point = key_points[static_cast<size_t>(i)];
    features.key_points.push_back(
        {scale * (point.pt.x - shift) + middle, scale * (point.pt.y - shift) + middle, scale * point.size});
    const std::uint8_t* row = descriptors.ptr(i);
    features.descriptors.insert(features.descriptors.end(), row,
                                row + descriptors.step1() * descriptors.elemSize1());
  }
  return features;
}

std::vector<FeatureMatch> MatchFeatures(const Features& features1, const Features& features2,
                                        const MatcherOptions& options) {
  if (features1.key_points.empty() || features2.key_points.size() < 2) return {};
  const cv::Mat rows1 = MakeDescriptorMatrix(features1), rows2 = MakeDescriptorMatrix(features2);
  std::vector<FeatureMatch> matches = MatchNearest(rows1, rows2, features1.is_binary, options.max_ratio);
  if (options.is_mutual) {
    KeepMutual(rows1, rows2, features1.is_binary, &matches);
    KeepOnePerPlace(features1.key_points, &FeatureMatch::at1, &matches);
    KeepOnePerPlace(features2.key_points, &FeatureMatch::at2, &matches);
  }
  return matches;
}

double SigmaOfMatch(Detector detector, const KeyPoint& point1, const KeyPoint& point2, int scale1,
                    int scale2) {
  constexpr double kFinestSigmaPx = 0.5, kGrowth = 0.7;
  const double size =
      std::hypot(point1.size_px / static_cast<float>(scale1), point2.size_px / static_cast<float>(scale2)) /
      std::sqrt(2.0);
  const double scale = std::hypot(scale1, scale2) / std::sqrt(2.0);
  return scale * kFinestSigmaPx * std::pow(size / FinestSize(detector), kGrowth);
}

}  // namespace rcme
