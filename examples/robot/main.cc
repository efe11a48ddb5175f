// How a visual SLAM starts its map: key frames are matched with the first one until the motion between them
// is known well enough. The matches are simulated here; a robot takes them from its front end.
#include <cmath>
#include <cstdio>
#include <opencv2/core.hpp>
#include <vector>

#include "robot/two_view.h"

namespace {

struct Frame {
  std::vector<cv::KeyPoint> keys;
};

constexpr double kF = 458.0, kCx = 367.0, kCy = 248.0;  // a camera of 752 x 480 pixels

// What the camera sees after it has moved to the side by `shift`, in the unit of the depths: 250 points of
// which every sixth is matched wrongly, with noise of 0.3 px.
Frame See(const std::vector<cv::Point3d>& points, double shift, cv::RNG& rng) {
  Frame frame;
  for (size_t i = 0; i < points.size(); ++i) {
    const cv::Point3d X = points[i] - cv::Point3d(shift, 0.0, 0.0);
    cv::Point2d x(kF * X.x / X.z + kCx + rng.gaussian(0.3), kF * X.y / X.z + kCy + rng.gaussian(0.3));
    if (shift > 0.0 && i % 6 == 0) x = {rng.uniform(0.0, 752.0), rng.uniform(0.0, 480.0)};
    frame.keys.emplace_back(cv::Point2f(x), 31.0F);
  }
  return frame;
}

}  // namespace

int main() {
  cv::RNG rng(1);
  std::vector<cv::Point3d> points;
  for (int i = 0; i < 250; ++i) {
    const double z = rng.uniform(4.0, 12.0);
    points.emplace_back(z * rng.uniform(-0.7, 0.7), z * rng.uniform(-0.5, 0.5), z);
  }
  const cv::Mat K = (cv::Mat_<double>(3, 3) << kF, 0, kCx, 0, kF, kCy, 0, 0, 1);
  rcme::TwoViewOptions options;
  options.K1 = options.K2 = K;
  options.size1 = options.size2 = cv::Size(752, 480);
  options.sigma_px = 0.3;
  const rcme::TwoViewInitializer initializer(options);

  const Frame first = See(points, 0.0, rng);
  std::vector<int> matches12;  // key point i of the first frame is matched with key point i
  for (int i = 0; i < static_cast<int>(first.keys.size()); ++i) matches12.push_back(i);
  for (const double shift : {0.0005, 0.01, 0.5}) {
    const Frame frame = See(points, shift, rng);
    const rcme::TwoViewMotion motion = initializer.Estimate(first.keys, frame.keys, matches12);
    std::printf("moved by %g: %s (%s), P(wrong) %.3f\n  %s\n", shift, rcme::Name(motion.verdict),
                motion.status.c_str(), motion.failure_probability, motion.message.c_str());
    if (motion.verdict != rcme::TwoViewVerdict::kGood) continue;  // the next frame, please

    int num_points = 0;
    for (const bool is_there : motion.is_triangulated) num_points += is_there;
    const double deg = 180.0 / CV_PI;
    std::printf(
        "  t = (%.3f, %.3f, %.3f), its direction known to %.2f deg, the rotation to %.3f deg; %d map "
        "points\n",
        motion.t.at<double>(0), motion.t.at<double>(1), motion.t.at<double>(2),
        deg * std::sqrt(motion.covariance.at<double>(3, 3) + motion.covariance.at<double>(4, 4)),
        deg * std::sqrt(cv::trace(motion.covariance(cv::Rect(0, 0, 3, 3)))[0]), num_points);
    return motion.t.at<double>(0) < -0.99 ? 0 : 1;  // the camera went to the right: the points to the left
  }
  std::printf("no map\n");
  return 1;
}
