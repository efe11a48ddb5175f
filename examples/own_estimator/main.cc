// A user's own estimator in the whole framework: OpenCV's five-point RANSAC, with the first-order
// covariance of its inliers. Everything else is the program `rcme`.

#include <opencv2/calib3d.hpp>

#include "estimator/estimator_registry.h"
#include "estimator/problem_check.h"
#include "estimator/uncertainty/motion_covariance.h"
#include "experiments/program.h"

namespace {

struct OpenCvOptions {
  double threshold_sigmas = 1.96;  // a match that is off by more is an outlier
  double confidence = 0.999;       // that one sample at least is free of outliers
  int min_inliers = 5;
};

class OpenCvEstimator : public rcme::MotionEstimator {
 public:
  explicit OpenCvEstimator(const OpenCvOptions& options) : options_(options) {}

  rcme::MotionEstimate Estimate(const rcme::MotionProblem& problem, rcme::RandomStream&) const override {
    // NaN, too few matches, a camera without an inverse, ...: a status and a message.
    if (const auto refusal = rcme::RefuseUnsolvable(problem, 5)) return *refusal;
    rcme::MotionEstimate estimate;
    // Rays, so that both cameras may differ; the threshold in units of the mean focal length.
    std::vector<cv::Point2d> rays1, rays2;
    for (const rcme::Correspondence& match : problem.matches) {
      const Eigen::Vector3d ray1 = problem.camera1.Ray(match.x1_px), ray2 = problem.camera2.Ray(match.x2_px);
      rays1.emplace_back(ray1.x(), ray1.y());
      rays2.emplace_back(ray2.x(), ray2.y());
    }
    const double focal_px = 0.5 * (problem.camera1.fx + problem.camera2.fx);
    const double threshold = options_.threshold_sigmas * problem.sigma_px / focal_px;
    cv::Mat mask, R, t;
    const cv::Mat K = cv::Mat::eye(3, 3, CV_64F);
    const cv::Mat E = cv::findEssentialMat(rays1, rays2, K, cv::RANSAC, options_.confidence, threshold, mask);
    if (E.rows != 3 || cv::recoverPose(E, rays1, rays2, K, R, t, mask) < options_.min_inliers) {
      estimate.status = rcme::MotionStatus::kNoCandidate;
      estimate.message = "no essential matrix has enough inliers in front of both cameras";
      return estimate;
    }
    std::vector<rcme::Correspondence> inliers;
    for (int i = 0; i < mask.rows; ++i) {
      if (!mask.at<unsigned char>(i)) continue;
      estimate.inliers.push_back(i);
      inliers.push_back(problem.matches[static_cast<size_t>(i)]);
    }
    for (int row = 0; row < 3; ++row) {
      estimate.cam2_from_cam1.t(row) = t.at<double>(row);
      for (int col = 0; col < 3; ++col) estimate.cam2_from_cam1.R(row, col) = R.at<double>(row, col);
    }
    const auto covariance = rcme::FirstOrderMotionCovariance(estimate.cam2_from_cam1, problem.camera1,
                                                             problem.camera2, inliers, problem.sigma_px);
    estimate.status = covariance ? rcme::MotionStatus::kOk : rcme::MotionStatus::kDegenerateMatches;
    if (covariance) estimate.pose_cov = *covariance;
    estimate.message = covariance ? "found" : "the inliers do not determine a motion";
    return estimate;
  }

 private:
  OpenCvOptions options_;
};

// The estimator with its options, as studies, `--set` and `rcme tune` see them.
class OpenCvModel : public rcme::EstimatorModel {
 public:
  std::vector<rcme::Parameter> Parameters() override {
    using rcme::Parameter;
    return {Parameter::Real("threshold_sigmas", &options_.threshold_sigmas, {0.1, 100.0}, "sigma",
                            "a match that is off by more is an outlier"),
            Parameter::Real("confidence", &options_.confidence, {0.5, 0.999999}, "",
                            "that one sample at least is free of outliers; sets the number of samples"),
            Parameter::Integer("min_inliers", &options_.min_inliers, {5, 1e6},
                               "refuse a motion with fewer inliers in front of both cameras")};
  }
  void LiftLimits() override { options_.min_inliers = OpenCvOptions().min_inliers; }
  std::unique_ptr<rcme::MotionEstimator> Make() const override {
    return std::make_unique<OpenCvEstimator>(options_);
  }

 private:
  OpenCvOptions options_;
};

}  // namespace

int main(int argc, char** argv) {
  rcme::AddEstimator({"opencv", "OpenCV's findEssentialMat (RANSAC) and recoverPose",
                      [] { return std::make_unique<OpenCvModel>(); }});
  return rcme::RunProgram(argc, argv);
}
