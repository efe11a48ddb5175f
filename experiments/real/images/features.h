// The front end: detects key points of an image and matches those of two images, by OpenCV.
//
// The standard deviation of a match depends on the scale at which its key points were found. From the root
// mean square of their sizes (OpenCV's diameters), a match has
//
//   sigma_px = 0.5 px (size / size of the detector's finest scale)^0.7
//
// that is, the usual noise level at the finest scale, and more at coarser ones. Only the ratios matter: the
// level itself is to be estimated. On rendered images residuals grow with the power 0.8 to 0.9 of the size
// (SIFT), 1 (ORB) and 1.3 to 1.9 (AKAZE; tests/experiments/real/images/features_test.cc bounds them). On
// real pairs they grow 4 to 9 times over the range of sizes, less than proportionally. Too great a power is
// worse than too small a one, because it gives all the weight to few matches (results/stated_noise); hence
// 0.7.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/real/images/grey_image.h"

namespace rcme {

enum class Detector { kSift, kOrb, kAkaze };
const std::vector<std::pair<std::string, Detector>>& DetectorNames();

struct DetectorOptions {
  Detector detector = Detector::kSift;
  int max_features = 0;  // keep the strongest; 0: all (ORB: 2,000, as in ORB-SLAM2)
  // ORB places key points at whole pixels of its scales. This moves those of the two finest scales to the
  // corner nearby, where the gradients of a window are perpendicular to the lines to it (cv::cornerSubPix).
  // Moves of more than 2 px are not made.
  bool refines_corners = false;
};

struct KeyPoint {
  float x_px = 0.0f, y_px = 0.0f;  // (0, 0) is the centre of the top-left pixel
  float size_px = 0.0f;            // OpenCV's diameter of the key point
};

struct Features {
  std::vector<KeyPoint> key_points;
  std::vector<std::uint8_t> descriptors;  // of all key points, one after the other, equally long
  bool is_binary = false;                 // bits, compared by Hamming distance; else floats
  int scale = 1;                          // of the image in which they were found (GreyImage)
};

// Returns the number of bytes that describe a key point.
size_t CountDescriptorBytes(Detector detector);

// Detects features, deterministically for an image and options. Places and sizes are in pixels of the file,
// even if the image was scaled down. OpenCV 4.6 places SIFT key points a quarter of a pixel too far to the
// right and below, because it doubles the image about pixel borders and halves it about pixel centres (later
// versions have an option). This is corrected, as it would be a quarter of a pixel in the principal point.
// Throws InputError for refines_corners with another detector than ORB.
Features DetectFeatures(const GreyImage& image, const DetectorOptions& options);

struct MatcherOptions {
  double max_ratio = 0.8;  // Lowe's test: nearest / second nearest distance; 1: no test
  bool is_mutual = true;   // each key point must be the other's nearest
};

// A match by the indices of its key points. With a mutual matcher, a key point of either image has at most
// one match; otherwise one of image 2 may have several.
struct FeatureMatch {
  std::uint32_t at1 = 0, at2 = 0;
  float ratio = 0.0f;  // nearest / second nearest distance, in [0, 1]: less is better
  friend bool operator==(const FeatureMatch&, const FeatureMatch&) = default;
};
std::vector<FeatureMatch> MatchFeatures(const Features& features1, const Features& features2,
                                        const MatcherOptions& options);

// The sigma_px above, for key points in images at these scales. In an image that was scaled down by two, the
// error of a key point is twice as many pixels of the file as that of one with the same size in that image.
double SigmaOfMatch(Detector detector, const KeyPoint& point1, const KeyPoint& point2, int scale1 = 1,
                    int scale2 = 1);

}  // namespace rcme
