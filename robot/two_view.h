// The motion between two images for a robot's program: takes OpenCV's types and returns motion, covariance,
// failure probability and a verdict. Include this header and link rcme::robot; nothing else of rcme is
// needed.
//
//   const rcme::TwoViewInitializer initializer({.K1 = K, .K2 = K, .size1 = size, .size2 = size});
//   const rcme::TwoViewMotion motion = initializer.Estimate(points1, points2);
//   if (motion.verdict == rcme::TwoViewVerdict::kGood) ...
//
// Frames: a point X1 in camera 1's frame (x right, y down, z forward) is X2 = R X1 + t in camera 2's. The
// scale is not observable: |t| = 1. Image points are pixels of undistorted images; (0, 0) is the centre of
// the top-left pixel.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <utility>
#include <vector>

namespace rcme {

class MotionEstimator;

struct TwoViewOptions {
  cv::Mat K1, K2;         // 3x3, CV_32F or CV_64F, [fx 0 cx; 0 fy cy; 0 0 1], px
  cv::Size size1, size2;  // of the images, px
  // Assumed noise per coordinate. rcme_calibrated, the default estimator, starts from it and estimates the
  // noise; a large difference between the two counts as a reason for doubt.
  double sigma_px = 0.5;
  double greatest_failure_probability = 0.05;  // a motion with a greater one is kDoubtful
  std::string estimator = "rcme_calibrated";   // any of `rcme list estimators` except other libraries'
  // Name and value of each option, as in `rcme list options`.
  std::vector<std::pair<std::string, std::string>> options = {{"covariance", "robust"}};
  // A file written by `rcme conform`. It replaces estimator and options. Covariance and probability are then
  // those that the file promises, and answers that its accept rule rejects are refused. Empty: none.
  std::string conform;
  std::uint64_t seed = 1;        // of the random samples: equal input gives an equal answer
  double integrity_risk = 1e-3;  // of the protection levels, in [1e-12, 1)
};

enum class TwoViewVerdict {
  kGood,      // a motion, wrong with a probability of at most greatest_failure_probability
  kDoubtful,  // a motion that is more likely wrong, or has no stated probability, or comes from matches
              // unlike those behind the file `conform`
  kRefused,   // no motion: too few matches, no parallax, no more agreement than by chance, ...; see `status`
              // and `message`
  kBadInput,  // nothing was computed: `message` says what is wrong
};
const char* Name(TwoViewVerdict verdict);

// Matrices are CV_64F. Without a motion matrices are empty and numbers NaN.
struct TwoViewMotion {
  TwoViewVerdict verdict = TwoViewVerdict::kBadInput;
  std::string status;   // the estimator's word: "ok", "no_candidate", "direction_not_observable", ...
  std::string message;  // one sentence for a person

  cv::Mat R, t;  // 3x3, 3x1
  // 5x5, rad^2, of [w; b]: to first order the true rotation is Exp(w) R (w along camera 2's axes) and the
  // true direction is t + B b, normalised.
  cv::Mat covariance;
  cv::Mat direction_basis;  // B, 3x2, orthonormal, normal to t
  // The probability that the rotation error exceeds 3 degrees or the direction error 15, or the bounds in the
  // options.
  double failure_probability = std::numeric_limits<double>::quiet_NaN();
  // Whether failure_probability was verified on matches like these: "verified", "extrapolated" or
  // "not_stated".
  std::string probability_domain = "not_stated";
  double sigma_px = std::numeric_limits<double>::quiet_NaN();  // estimated from the residuals
  // The angles, rad, that the error of the rotation and that of the direction exceed with probability at most
  // integrity_risk each, by the covariance and the failure probability. pi: no smaller angle has this
  // property (estimator/protection_level.h).
  double rotation_protection_level = std::numeric_limits<double>::quiet_NaN();
  double direction_protection_level = std::numeric_limits<double>::quiet_NaN();

  // One entry per match: whether the match agrees with the motion; its point in camera 1's frame, in units of
  // the baseline; whether there is a point (the match agrees, and the point lies in front of both cameras).
  std::vector<bool> is_inlier;
  std::vector<cv::Point3f> points;
  std::vector<bool> is_triangulated;
};

// The contents of ROS' geometry_msgs/PoseWithCovariance: the pose of camera 2 in the frame of camera 1. Both
// frames are optical frames (x right, y down, z forward; REP 103), so header.frame_id is that of camera 1's
// image. A point X2 in camera 2's frame is orientation * X2 + position in camera 1's.
struct RosPose {
  std::array<double, 3> position{};     // x, y, z: -R't, of unit length (the scale is not observable)
  std::array<double, 4> orientation{};  // quaternion x, y, z, w of R', w >= 0
  // 6x6, row-major, of [x, y, z, rotation about X, about Y, about Z]: dp in units of the length of the
  // translation, d in rad. The true pose is position + dp and Exp(d) * orientation. As in ROS, the rotation
  // error is about the fixed axes of camera 1 and applied after the estimated rotation;
  // TwoViewMotion::covariance instead uses the axes of camera 2. To first order; rank 5, zero along the
  // position. For a translation of length s multiply position by s, then the first three rows and the first
  // three columns by s, and add the variance of s times position * position'.
  std::array<double, 36> covariance{};
};

// Throws std::runtime_error if there is no motion (kRefused, kBadInput).
RosPose ComputeRosPose(const TwoViewMotion& motion);

// Const; several threads may call it at once.
class TwoViewInitializer {
 public:
  // Throws std::runtime_error for invalid options: K, sizes, an unknown estimator or option, an unreadable
  // file `conform`.
  explicit TwoViewInitializer(const TwoViewOptions& options);
  ~TwoViewInitializer();

  // points1[i] is matched with points2[i]. Never throws for bad input: lists of different length, few
  // matches, points that are not finite.
  //
  // sigmas: the standard deviation of each match, if the front end knows it (that of a key point grows with
  // its scale). Any unit, as only the ratios count; empty: equal for all.
  TwoViewMotion Estimate(const std::vector<cv::Point2f>& points1, const std::vector<cv::Point2f>& points2,
                         const std::vector<double>& sigmas = {}) const;

  // The calling convention of ORB-SLAM2's initialiser: matches12[i] is the key point of image 2 matched with
  // key point i of image 1, or -1. The lists of the answer have one entry per key point of image 1.
  TwoViewMotion Estimate(const std::vector<cv::KeyPoint>& keys1, const std::vector<cv::KeyPoint>& keys2,
                         const std::vector<int>& matches12) const;

 private:
  struct Setup;
  std::unique_ptr<const Setup> setup_;
};

}  // namespace rcme
