// The front end: key points of an image and putative matches of two, by OpenCV.
//
// What a match's own sigma is: the error of a key point grows with the scale at which it was found. With the
// root mean square of its key points' sizes (the diameters OpenCV gives) a match has
//
//   sigma_px = 0.5 px (size / size of the detector's finest scale)^0.7
//
// the noise level assumed everywhere at the finest scale, more beyond. Only its growth is meant: the level is
// to be estimated. On rendered images residuals grow with the power 0.8 to 0.9 of the size (SIFT), 1 (ORB)
// and 1.3 to 1.9 (AKAZE; tests/experiments/real/images/features_test.cc holds them within bounds), on real
// pairs 4 to 9 times over the sizes, less than proportionally. A power too great costs more than one too
// small, as it gives all the weight to few matches (results/stated_noise): hence 0.7.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "estimator/geometry/correspondence.h"
#include "experiments/real/images/grey_image.h"

namespace rcme {

enum class Detector { kSift, kOrb, kAkaze };
const std::vector<std::pair<std::string, Detector>>& DetectorNames();

struct DetectorOptions {
  Detector detector = Detector::kSift;
  int max_features = 0;  // the strongest; 0: all (ORB: 2,000, as ORB-SLAM2's)
};

struct KeyPoint {
  float x_px = 0.0f, y_px = 0.0f;  // (0, 0) is the centre of the top-left pixel
  float size_px = 0.0f;            // diameter of what it was found in
};

struct Features {
  std::vector<KeyPoint> key_points;
  std::vector<std::uint8_t> descriptors;  // of all key points, one after another, each as long as the others
  bool is_binary = false;                 // bits, compared by Hamming's distance; else floats
  int scale = 1;                          // of the image in which they were found (GreyImage)
};

// How many bytes describe a key point.
size_t CountDescriptorBytes(Detector detector);

// The same for the same image and options. OpenCV 4.6 places what SIFT finds a quarter of a pixel to the
// right and below (it doubles the image about pixel borders and halves about pixel centres; later versions
// have an option), which is taken back: a quarter of a pixel in the principal point. Places and sizes are
// those in the file's pixels where the image was scaled down.
Features DetectFeatures(const GreyImage& image, const DetectorOptions& options);

struct MatcherOptions {
  double max_ratio = 0.8;  // Lowe's: nearest / second nearest; 1: no such test
  bool is_mutual = true;   // each is the other's nearest
};

// By the places of the two key points. A key point of either image is in one match at most where the matcher
// is mutual; else one of image 2 may be in several.
struct FeatureMatch {
  std::uint32_t at1 = 0, at2 = 0;
  float ratio = 0.0f;  // of the distances to the nearest and the second nearest, in [0, 1]: less is better
  friend bool operator==(const FeatureMatch&, const FeatureMatch&) = default;
};
std::vector<FeatureMatch> MatchFeatures(const Features& features1, const Features& features2,
                                        const MatcherOptions& options);

// As above, of key points in images at these scales: one found in an image that was scaled down by two errs
// by twice as many pixels of the file as one of the same size in that image.
double SigmaOfMatch(Detector detector, const KeyPoint& point1, const KeyPoint& point2, int scale1 = 1,
                    int scale2 = 1);

}  // namespace rcme
