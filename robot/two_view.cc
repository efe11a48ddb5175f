#include "robot/two_view.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <exception>
#include <stdexcept>

#include "estimator/conform/conform_estimator.h"
#include "estimator/estimator_registry.h"
#include "estimator/geometry/triangulation.h"
#include "estimator/noise_scale.h"
#include "estimator/protection_level.h"
#include "stats/random.h"

namespace rcme {
namespace {

Camera CameraFrom(const cv::Mat& K, const cv::Size& size, int number) {
  if (K.rows != 3 || K.cols != 3 || K.channels() != 1)
    throw std::runtime_error(
        fmt::format("K{}: {}x{} is not allowed; give a 3x3 matrix", number, K.rows, K.cols));
  cv::Mat_<double> k;
  K.convertTo(k, CV_64F);
  const bool is_of_pinhole =
      k(0, 1) == 0.0 && k(1, 0) == 0.0 && k(2, 0) == 0.0 && k(2, 1) == 0.0 && k(2, 2) == 1.0;
  const Camera camera{k(0, 0), k(1, 1), k(0, 2), k(1, 2), size.width, size.height};
  if (!is_of_pinhole || !camera.IsValid() || camera.fx < 0.0 || camera.fy < 0.0) {
    throw std::runtime_error(
        fmt::format("K{} or size{} ({} x {}): not a camera; give [fx 0 cx; 0 fy cy; 0 0 1] with fx, fy above "
                    "0 and the size of "
                    "the image in px",
                    number, number, size.width, size.height));
  }
  return camera;
}

template <typename Matrix>
cv::Mat ToCv(const Matrix& matrix) {
  cv::Mat_<double> copy(static_cast<int>(matrix.rows()), static_cast<int>(matrix.cols()));
  for (int r = 0; r < copy.rows; ++r) {
    for (int c = 0; c < copy.cols; ++c) copy(r, c) = matrix(r, c);
  }
  return cv::Mat(copy);
}

TwoViewMotion BadInput(const std::string& message) {
  TwoViewMotion bad;
  bad.status = StatusName(MotionStatus::kInvalidInput);
  bad.message = message;
  return bad;
}

void Triangulate(const MotionProblem& problem, const RelativePose& pose, TwoViewMotion* motion) {
  for (size_t i = 0; i < problem.matches.size(); ++i) {
    if (!motion->is_inlier[i]) continue;
    const Eigen::Vector3d ray1 = problem.camera1.Ray(problem.matches[i].x1_px),
                          ray2 = problem.camera2.Ray(problem.matches[i].x2_px);
    const double inverse_depth = InverseDepth(pose, ray1, ray2);
    if (!(inverse_depth > 0.0) || !IsInFrontOfBothCameras(pose, ray1, ray2)) continue;
    const Eigen::Vector3d point = ray1 / inverse_depth;
    motion->points[i] = {static_cast<float>(point.x()), static_cast<float>(point.y()),
                         static_cast<float>(point.z())};
    motion->is_triangulated[i] = true;
  }
}

std::unique_ptr<MotionEstimator> MakeChosen(const TwoViewOptions& options) {
  if (options.conform.empty()) return MakeEstimator(options.estimator, options.options);
  const std::unique_ptr<EstimatorModel> model = ConformModel();
  FindParameter(model->Parameters(), "file").SetFromText(options.conform);
  return model->Make();
}

template <int kRows, int kColumns>
Eigen::Matrix<double, kRows, kColumns> FromCv(const cv::Mat& matrix) {
  const cv::Mat_<double> numbers = matrix;
  Eigen::Matrix<double, kRows, kColumns> copy;
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kColumns; ++c) copy(r, c) = numbers(r, c);
  }
  return copy;
}

// d [position, rotation about camera 1's axes] / d [w, b], 6x5. From R <- Exp(w) R, t <- t + B b: R' becomes
// R' Exp(-w) = Exp(-R'w) R', and -R't becomes -R'(I - [w]x)(t + B b) = -R't - R'[t]x w - R' B b.
Eigen::Matrix<double, 6, 5> RosJacobian(const RelativePose& pose) {
  Eigen::Matrix<double, 6, 5> J = Eigen::Matrix<double, 6, 5>::Zero();
  J.topLeftCorner<3, 3>() = -pose.R.transpose() * CrossMatrix(pose.t);
  J.topRightCorner<3, 2>() = -pose.R.transpose() * DirectionBasis(pose.t);
  J.bottomLeftCorner<3, 3>() = -pose.R.transpose();
  return J;
}

// `is_conformed`: the answer's probability domain is that of the file `conform`.
TwoViewMotion MotionFrom(const MotionProblem& problem, const MotionEstimate& estimate,
                         double greatest_probability, double integrity_risk, bool is_conformed) {
  TwoViewMotion motion;
  const size_t n = problem.matches.size();
  motion.status = StatusName(estimate.status);
  motion.message = estimate.message;
  motion.failure_probability = estimate.failure_probability;
  motion.probability_domain = Name(estimate.probability_domain);
  motion.sigma_px = estimate.sigma_estimated_px;
  motion.is_inlier.resize(n);
  motion.points.resize(n);
  motion.is_triangulated.resize(n);
  if (estimate.status == MotionStatus::kInvalidInput) return motion;
  motion.verdict = TwoViewVerdict::kRefused;
  if (estimate.status != MotionStatus::kOk) return motion;
  const RelativePose& pose = estimate.cam2_from_cam1;
  const bool is_promised = !is_conformed || estimate.probability_domain != ProbabilityDomain::kExtrapolated;
  motion.verdict = is_promised && estimate.failure_probability <= greatest_probability
                       ? TwoViewVerdict::kGood
                       : TwoViewVerdict::kDoubtful;
  motion.R = ToCv(pose.R);
  motion.t = ToCv(pose.t);
  motion.covariance = ToCv(estimate.pose_cov);
  motion.direction_basis = ToCv(DirectionBasis(pose.t));
  const ProtectionLevels levels = ComputeProtectionLevels(estimate, integrity_risk);
  motion.rotation_protection_level = levels.rotation_rad;
  motion.direction_protection_level = levels.direction_rad;
  for (const int i : estimate.inliers) motion.is_inlier[static_cast<size_t>(i)] = true;
  Triangulate(problem, pose, &motion);
  return motion;
}

}  // namespace

struct TwoViewInitializer::Setup {
  Camera camera1, camera2;
  double sigma_px, greatest_failure_probability, integrity_risk;
  std::uint64_t seed;
  std::unique_ptr<MotionEstimator> estimator;
  bool is_conformed;
};

const char* Name(TwoViewVerdict verdict) {
  switch (verdict) {
    case TwoViewVerdict::kGood:
      return "good";
    case TwoViewVerdict::kDoubtful:
      return "doubtful";
    case TwoViewVerdict::kRefused:
      return "refused";
    case TwoViewVerdict::kBadInput:
      break;
  }
  return "bad input";
}

RosPose ComputeRosPose(const TwoViewMotion& motion) {
  if (motion.R.empty() || motion.t.empty() || motion.covariance.empty())
    throw std::runtime_error(fmt::format("the answer has no motion, its status is {}", motion.status));
  const RelativePose pose{FromCv<3, 3>(motion.R), FromCv<3, 1>(motion.t)};
  const Eigen::Vector3d position = -pose.R.transpose() * pose.t;
  Eigen::Quaterniond orientation(Eigen::Matrix3d(pose.R.transpose()));
  if (orientation.w() < 0.0) orientation.coeffs() = -orientation.coeffs();
  const Eigen::Matrix<double, 6, 5> J = RosJacobian(pose);
  const Eigen::Matrix<double, 6, 6> covariance = J * FromCv<5, 5>(motion.covariance) * J.transpose();
  RosPose ros;
  for (size_t i = 0; i < 3; ++i) ros.position[i] = position(static_cast<Eigen::Index>(i));
  for (size_t i = 0; i < 4; ++i) ros.orientation[i] = orientation.coeffs()(static_cast<Eigen::Index>(i));
  for (size_t i = 0; i < 36; ++i)
    ros.covariance[i] = covariance(static_cast<Eigen::Index>(i / 6), static_cast<Eigen::Index>(i % 6));
  return ros;
}

TwoViewInitializer::TwoViewInitializer(const TwoViewOptions& options)
    : setup_(new Setup{CameraFrom(options.K1, options.size1, 1), CameraFrom(options.K2, options.size2, 2),
                       options.sigma_px, options.greatest_failure_probability, options.integrity_risk,
                       options.seed, MakeChosen(options), !options.conform.empty()}) {
  if (!(options.sigma_px > 0.0) || !std::isfinite(options.sigma_px))
    throw std::runtime_error(
        fmt::format("sigma_px: {} is not allowed; give a number above 0", options.sigma_px));
  if (!(options.greatest_failure_probability >= 0.0) || options.greatest_failure_probability > 1.0)
    throw std::runtime_error(
        fmt::format("greatest_failure_probability: {} is not allowed; give a number in [0, 1]",
                    options.greatest_failure_probability));
  if (!(options.integrity_risk >= 1e-12) || options.integrity_risk >= 1.0)
    throw std::runtime_error(fmt::format("integrity_risk: {} is not allowed; give a number in [1e-12, 1)",
                                         options.integrity_risk));
}

TwoViewInitializer::~TwoViewInitializer() = default;

TwoViewMotion TwoViewInitializer::Estimate(const std::vector<cv::Point2f>& points1,
                                           const std::vector<cv::Point2f>& points2,
                                           const std::vector<double>& sigmas) const {
  if (points1.size() != points2.size()) {
    return BadInput(fmt::format("{} points of image 1 and {} of image 2 are no matches; give as many of both",
                                points1.size(), points2.size()));
  }
  try {
    MotionProblem problem{{}, setup_->camera1, setup_->camera2, setup_->sigma_px};
    for (size_t i = 0; i < points1.size(); ++i)
      problem.matches.push_back({{points1[i].x, points1[i].y}, {points2[i].x, points2[i].y}});
    problem.noise_scale = ComputeNoiseScale(sigmas);
    RandomStream rng({.seed = setup_->seed});
    return MotionFrom(problem, setup_->estimator->Estimate(problem, rng),
                      setup_->greatest_failure_probability, setup_->integrity_risk, setup_->is_conformed);
  } catch (const std::exception& error) {  // the robot goes on without this pair
    return BadInput(fmt::format("internal error: {}", error.what()));
  }
}

TwoViewMotion TwoViewInitializer::Estimate(const std::vector<cv::KeyPoint>& keys1,
                                           const std::vector<cv::KeyPoint>& keys2,
                                           const std::vector<int>& matches12) const {
  if (matches12.size() != keys1.size())
    return BadInput(
        fmt::format("matches12 has {} entries for {} key points of image 1", matches12.size(), keys1.size()));
  std::vector<cv::Point2f> points1, points2;
  std::vector<size_t> places;
  for (size_t i = 0; i < keys1.size(); ++i) {
    if (matches12[i] < 0) continue;
    const auto other = static_cast<size_t>(matches12[i]);
    if (other >= keys2.size()) {
      return BadInput(
          fmt::format("matches12[{}] is {}; image 2 has {} key points", i, matches12[i], keys2.size()));
    }
    points1.push_back(keys1[i].pt);
    points2.push_back(keys2[other].pt);
    places.push_back(i);
  }
  TwoViewMotion motion = Estimate(points1, points2);
  const TwoViewMotion of_matches = motion;
  motion.is_inlier.assign(keys1.size(), false);
  motion.is_triangulated.assign(keys1.size(), false);
  motion.points.assign(keys1.size(), cv::Point3f());
  if (of_matches.is_inlier.empty()) return motion;
  for (size_t k = 0; k < places.size(); ++k) {
    motion.is_inlier[places[k]] = of_matches.is_inlier[k];
    motion.is_triangulated[places[k]] = of_matches.is_triangulated[k];
    motion.points[places[k]] = of_matches.points[k];
  }
  return motion;
}

}  // namespace rcme
