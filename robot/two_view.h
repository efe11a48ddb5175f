// The motion between two images for a robot's program: OpenCV's types in, motion, covariance, probability of
// failure and a verdict out. Nothing else of rcme is needed: include this header, link rcme::robot.
//
//   const rcme::TwoViewInitializer initializer({.K1 = K, .K2 = K, .size1 = image.size(), .size2 =
//   image.size()}); const rcme::TwoViewMotion motion = initializer.Estimate(points1, points2); if
//   (motion.verdict == rcme::TwoViewVerdict::kGood) ...
//
// Frames: a point X1 in camera 1's frame (x right, y down, z forward) is X2 = R X1 + t in camera 2's; the
// scale cannot be seen, |t| = 1. Image points are pixels of undistorted images, (0, 0) being the centre of
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
  double sigma_px = 0.5;  // assumed noise per coordinate; rcme_calibrated, the default, estimates it and
                          // takes this as a guess, one that is far off as a reason for doubt
  double greatest_failure_probability = 0.05;  // a motion that is more likely wrong is kDoubtful
  std::string estimator = "rcme_calibrated";   // any of `rcme list estimators` but those of other libraries
  // By name, as `rcme list options` has them.
  std::vector<std::pair<std::string, std::string>> options = {{"covariance", "robust"}};
  // A file of `rcme conform`, in place of estimator and options, which it names: covariance and probability
  // are then those that it promises, and what its accept rule does not accept is refused. Empty: none.
  std::string conform;
  std::uint64_t seed = 1;        // of the samples: equal input, equal answer
  double integrity_risk = 1e-3;  // of the protection levels, in [1e-12, 1)
};

enum class TwoViewVerdict {
  kGood,      // a motion, wrong with a probability of at most greatest_failure_probability
  kDoubtful,  // a motion that is more likely wrong, or whose estimator states no probability, or of matches
              // unlike those that the file `conform` is of
  kRefused,   // no motion: too few matches, no parallax, no more agreement than by chance, ... (`status`,
              // `message`)
  kBadInput,  // nothing was computed: `message` says what is wrong
};
const char* Name(TwoViewVerdict verdict);

// Matrices are CV_64F; empty, and numbers NaN, where there is no motion.
struct TwoViewMotion {
  TwoViewVerdict verdict = TwoViewVerdict::kBadInput;
  std::string status;   // the estimator's word: "ok", "no_candidate", "direction_not_observable", ...
  std::string message;  // one sentence for a person

  cv::Mat R, t;  // 3x3, 3x1
  // 5x5, rad^2, of [w; b]: the true rotation is Exp(w) R (w along camera 2's axes), the true direction is t +
  // B b normalised, to first order.
  cv::Mat covariance;
  cv::Mat direction_basis;  // B, 3x2, orthonormal, normal to t
  // That the rotation is off by more than 3 degrees or the direction by more than 15, or what bounds the
  // options name.
  double failure_probability = std::numeric_limits<double>::quiet_NaN();
  // Whether that holds for matches such as these: "verified", "extrapolated" or "not_stated".
  std::string probability_domain = "not_stated";
  double sigma_px = std::numeric_limits<double>::quiet_NaN();  // as estimated from the residuals
  // The angles, rad, that the error of the rotation and that of the direction exceed with a probability of at
  // most integrity_risk each, by the covariance and the failure probability; pi: that is as probable for
  // every angle (estimator/protection_level.h).
  double rotation_protection_level = std::numeric_limits<double>::quiet_NaN();
  double direction_protection_level = std::numeric_limits<double>::quiet_NaN();

  // One per match given: whether it agrees with the motion; its point in camera 1's frame, baselines, and
  // whether there is one (it agrees, and lies in front of both cameras).
  std::vector<bool> is_inlier;
  std::vector<cv::Point3f> points;
  std::vector<bool> is_triangulated;
};

// What ROS' geometry_msgs/PoseWithCovariance holds: the pose of camera 2 in the frame of camera 1. Both
// frames are optical frames (x right, y down, z forward; REP 103), so that header.frame_id is that of camera
// 1's image. A point X2 in camera 2's frame is orientation * X2 + position in camera 1's.
struct RosPose {
  std::array<double, 3> position{};     // x, y, z: -R't, of unit length, as the scale cannot be seen
  std::array<double, 4> orientation{};  // quaternion x, y, z, w of R', w >= 0
  // 6x6, row-major, of [x, y, z, rotation about X, about Y, about Z]: dp in units of the length of the
  // translation, d in rad. The true pose is position + dp and Exp(d) * orientation: the rotation is about the
  // fixed axes of camera 1, as ROS has it, and follows the estimated one. That of t and R of the motion is
  // about the axes of camera 2. To first order; rank 5, with nothing along the position. For a translation of
  // the length s multiply position by s, the first three rows and then the first three columns by s, and add
  // the variance of s times position * position'.
  std::array<double, 36> covariance{};
};

// Throws std::runtime_error for a motion without one: kRefused and kBadInput.
RosPose ComputeRosPose(const TwoViewMotion& motion);

// Const, and may be called from several threads at once.
class TwoViewInitializer {
 public:
  // Throws std::runtime_error for options that make no sense, which are the programmer's: K, sizes, an
  // unknown estimator or option, a file `conform` that is none.
  explicit TwoViewInitializer(const TwoViewOptions& options);
  ~TwoViewInitializer();

  // points1[i] is matched with points2[i]. Never throws for what a front end may give: lists of different
  // length, few matches, points that are not finite.
  //
  // sigmas: each match's own standard deviation, where the front end knows which are noisier (a key point's
  // grows with the scale it is found at). Only their relation counts, in any unit; empty: all alike.
  TwoViewMotion Estimate(const std::vector<cv::Point2f>& points1, const std::vector<cv::Point2f>& points2,
                         const std::vector<double>& sigmas = {}) const;

  // As ORB-SLAM2's initialiser is called: matches12[i] is the key point of image 2 that is matched with key
  // point i of image 1, or -1. The lists of the answer have one entry per key point of image 1.
  TwoViewMotion Estimate(const std::vector<cv::KeyPoint>& keys1, const std::vector<cv::KeyPoint>& keys2,
                         const std::vector<int>& matches12) const;

 private:
  struct Setup;
  std::unique_ptr<const Setup> setup_;
};

}  // namespace rcme
