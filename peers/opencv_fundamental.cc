// OpenCV's RANSAC and least median of squares, both for the fundamental matrix from seven points.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/calib3d.hpp>

#include "estimator/noise_scale.h"
#include "peers/peers.h"
#include "peers/recover_pose.h"

namespace rcme {
namespace {

constexpr int kSampleSize = 7;

// Defaults are those of cv::findFundamentalMat.
struct FundamentalOptions {
  int method = cv::FM_RANSAC;
  double threshold_sigma = 2.0;  // FM_RANSAC only
  double confidence = 0.99;
  int max_iterations = 1000;
  double max_depth = kDefaultMaxDepth;
};

// FM_RANSAC compares the threshold with the larger of the distances between a match's two points and their
// epipolar lines, |e| / min(|l1|, |l2|), e the constraint and l1, l2 the normals of the lines. The variance
// of e is sigma^2 (|l1|^2 + |l2|^2). In rays both normals have about the same length, in pixels that length
// over the focal length. The standard deviation of the distance is therefore sigma sqrt(1 + r^2), r the
// larger focal length over the smaller (sqrt(2) sigma for equal ones). FM_LMEDS has no threshold: inliers are
// the matches within 2.5 robust standard deviations, 1.4826 (1 + 5 / (n - 7)) times the median of the
// distances.
double ThresholdPx(const FundamentalOptions& options, const MotionProblem& problem) {
  const double focal1 = std::hypot(problem.camera1.fx, problem.camera1.fy);
  const double focal2 = std::hypot(problem.camera2.fx, problem.camera2.fy);
  const double ratio = std::max(focal1, focal2) / std::min(focal1, focal2);
  return std::hypot(1.0, ratio) * options.threshold_sigma * problem.sigma_px;
}

// Finds F, then E = K2' F K1, then the motion of the nearest essential matrix. Both methods draw samples from
// a generator with a fixed seed; the stream determines the order in which OpenCV gets the matches. For
// exactly seven matches OpenCV returns up to three F: the first with the most points in front of both cameras
// is used.
std::optional<PeerAnswer> AskFindFundamentalMat(const MotionProblem& problem,
                                                const FundamentalOptions& options, RandomStream& rng) {
  std::vector<int> order(problem.matches.size());
  std::iota(order.begin(), order.end(), 0);
  rng.Shuffle(std::span(order));
  const MotionProblem reordered = SelectPart(problem, order);
  const CvPoints points = ListPixels(reordered);
  cv::Mat mask;
  const cv::Mat Fs =
      cv::findFundamentalMat(points.image1, points.image2, options.method, ThresholdPx(options, problem),
                             options.confidence, options.max_iterations, mask);
  const cv::Mat K1(CvMatrix(problem.camera1.K())), K2(CvMatrix(problem.camera2.K()));
  std::optional<PeerAnswer> best;
  for (int row = 0; row + 3 <= Fs.rows; row += 3) {
    const cv::Mat E = K2.t() * Fs.rowRange(row, row + 3) * K1;
    std::optional<PeerAnswer> answer = RecoverPose(reordered, E, mask, options.max_depth);
    if (answer && (!best || answer->inliers.size() > best->inliers.size())) best = std::move(answer);
  }
  if (!best) return std::nullopt;
  for (int& i : best->inliers) i = order[static_cast<size_t>(i)];
  return best;
}

class OpenCvFundamental : public MotionEstimator {
 public:
  explicit OpenCvFundamental(const FundamentalOptions& options) : options_(options) {}

  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override {
    return CallPeer(problem, kSampleSize, "OpenCV",
                    [&] { return AskFindFundamentalMat(problem, options_, rng); });
  }

 private:
  FundamentalOptions options_;
};

class FundamentalModel : public EstimatorModel {
 public:
  explicit FundamentalModel(int method) { options_.method = method; }

  std::vector<Parameter> Parameters() override {
    FundamentalOptions& o = options_;
    std::vector<Parameter> all;
    const bool is_ransac = o.method == cv::FM_RANSAC;
    if (is_ransac) {
      all.push_back(Parameter::Real(
          "threshold_sigma", &o.threshold_sigma, {1e-3, 1e3}, "sigma",
          "inlier threshold in standard deviations of the distance; with fewer than 15 matches OpenCV "
          "takes LMedS instead"));
    }
    all.push_back(Parameter::Real(
        "confidence", &o.confidence, {0.01, 0.999999}, "",
        is_ransac ? "probability of a sample without wrong matches at which the loop ends"
                  : "probability of a sample without wrong matches where 45 % are wrong; sets the number of "
                    "samples"));
    all.push_back(
        Parameter::Integer("max_iterations", &o.max_iterations, {1, 1e6}, "greatest number of samples"));
    all.push_back(MaxDepthParameter(&o.max_depth));
    return all;
  }
  std::optional<Effort> EffortOption() const override { return Effort{"max_iterations", true}; }
  std::unique_ptr<MotionEstimator> Make() const override {
    return std::make_unique<OpenCvFundamental>(options_);
  }

 private:
  FundamentalOptions options_;
};

}  // namespace

std::unique_ptr<EstimatorModel> OpenCvRansacModel() {
  return std::make_unique<FundamentalModel>(cv::FM_RANSAC);
}
std::unique_ptr<EstimatorModel> OpenCvLmedsModel() {
  return std::make_unique<FundamentalModel>(cv::FM_LMEDS);
}

}  // namespace rcme
