// OpenCV's USAC for the essential matrix, with the camera matrices of both images.
#include <algorithm>
#include <functional>
#include <numeric>
#include <opencv2/calib3d.hpp>

#include "estimator/noise_scale.h"
#include "peers/peers.h"
#include "peers/recover_pose.h"

namespace rcme {
namespace {

// Defaults are those of cv::UsacParams.
struct UsacOptions {
  cv::ScoreMethod score = cv::SCORE_METHOD_MSAC;
  cv::LocalOptimMethod local_optimisation = cv::LOCAL_OPTIM_INNER_LO;
  cv::SamplingMethod sampler = cv::SAMPLING_UNIFORM;
  double threshold_sigma = 2.0;
  double confidence = 0.99;
  int max_iterations = 5000;
  double max_depth = kDefaultMaxDepth;
};

// Size and number of the samples of a local optimisation. UsacParams has one default for all methods; these
// are the values that OpenCV's own presets of each use for essential matrices (USAC_DEFAULT, USAC_ACCURATE,
// USAC_MAGSAC).
void SetLocalSamples(cv::UsacParams* params) {
  const bool is_cut = params->loMethod == cv::LOCAL_OPTIM_GC;
  const bool is_sigma = params->loMethod == cv::LOCAL_OPTIM_SIGMA;
  params->loSampleSize = is_cut ? 20 : is_sigma ? 50 : 21;
  params->loIterations = is_cut ? 25 : is_sigma ? 10 : 15;
}

// USAC compares the squared threshold with the symmetric epipolar distance e^2 (1 / |l1|^2 + 1 / |l2|^2), e
// the constraint and l1, l2 the normals of the two epipolar lines. The variance of e is sigma^2 (|l1|^2 +
// |l2|^2), so if both normals have the same length the distance has standard deviation 2 sigma. USAC takes
// the threshold in pixels and divides it by the mean of the four focal lengths.
double ThresholdPx(const UsacOptions& options, double sigma_px) {
  return 2.0 * options.threshold_sigma * sigma_px;
}

// Whether the sampler takes the first matches to be the best.
bool TakesBestFirst(cv::SamplingMethod sampler) {
  return sampler == cv::SAMPLING_PROSAC || sampler == cv::SAMPLING_PROGRESSIVE_NAPSAC;
}

// Returns the indices of the matches, greatest quality first; equal ones keep their order.
std::vector<int> OrderByQuality(const MotionProblem& problem) {
  std::vector<int> order(problem.matches.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, std::ranges::greater(),
                           [&](int i) { return problem.match_quality[static_cast<size_t>(i)]; });
  return order;
}

class OpenCvUsac : public MotionEstimator {
 public:
  explicit OpenCvUsac(const UsacOptions& options) : options_(options) {}

  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override {
    return CallPeer(problem, 5, "OpenCV", [&] { return AskBestFirst(problem, rng); });
  }

 private:
  // The inliers of the answer have the indices of the problem.
  std::optional<PeerAnswer> AskBestFirst(const MotionProblem& problem, RandomStream& rng) const {
    if (problem.match_quality.empty() || !TakesBestFirst(options_.sampler)) return Ask(problem, rng);
    const std::vector<int> order = OrderByQuality(problem);
    std::optional<PeerAnswer> answer = Ask(SelectPart(problem, order), rng);
    if (!answer) return std::nullopt;
    for (int& i : answer->inliers) i = order[static_cast<size_t>(i)];
    return answer;
  }

  std::optional<PeerAnswer> Ask(const MotionProblem& problem, RandomStream& rng) const {
    cv::UsacParams params;
    params.score = options_.score;
    params.loMethod = options_.local_optimisation;
    params.sampler = options_.sampler;
    params.threshold = ThresholdPx(options_, problem.sigma_px);
    params.confidence = options_.confidence;
    params.maxIterations = options_.max_iterations;
    params.isParallel = false;
    params.randomGeneratorState = static_cast<int>(rng.Next32() >> 2);  // USAC adds small numbers to it
    SetLocalSamples(&params);
    const CvPoints points = ListPixels(problem);
    cv::Mat mask;
    const cv::Mat E =
        cv::findEssentialMat(points.image1, points.image2, CvMatrix(problem.camera1.K()),
                             CvMatrix(problem.camera2.K()), cv::noArray(), cv::noArray(), mask, params);
    if (E.rows != 3 || E.cols != 3) return std::nullopt;
    return RecoverPose(problem, E, mask, options_.max_depth);
  }

  UsacOptions options_;
};

class UsacModel : public EstimatorModel {
 public:
  std::vector<Parameter> Parameters() override {
    UsacOptions& o = options_;
    return {
        Parameter::Choice("score", &o.score,
                          {{"msac", cv::SCORE_METHOD_MSAC},
                           {"magsac", cv::SCORE_METHOD_MAGSAC},
                           {"lmeds", cv::SCORE_METHOD_LMEDS}},
                          "criterion of the best hypothesis"),
        Parameter::Choice("local_optimisation", &o.local_optimisation,
                          {{"none", cv::LOCAL_OPTIM_NULL},
                           {"inner", cv::LOCAL_OPTIM_INNER_LO},
                           {"inner_and_iterative", cv::LOCAL_OPTIM_INNER_AND_ITER_LO},
                           {"graph_cut", cv::LOCAL_OPTIM_GC},
                           {"sigma", cv::LOCAL_OPTIM_SIGMA}},
                          "of each new best hypothesis; sigma: MAGSAC++"),
        Parameter::Choice(
            "sampler", &o.sampler,
            {{"uniform", cv::SAMPLING_UNIFORM},
             {"prosac", cv::SAMPLING_PROSAC},
             {"napsac", cv::SAMPLING_NAPSAC},
             {"progressive_napsac", cv::SAMPLING_PROGRESSIVE_NAPSAC}},
            "prosac, progressive_napsac: best matches first, by the match file's score, else as listed"),
        Parameter::Real("threshold_sigma", &o.threshold_sigma, {1e-3, 1e3}, "sigma",
                        "inlier threshold in standard deviations of the distance; magsac: 3.2 times that"),
        Parameter::Real("confidence", &o.confidence, {0.01, 0.999999}, "",
                        "probability of a sample without wrong matches at which the loop ends"),
        Parameter::Integer("max_iterations", &o.max_iterations, {1, 1e6}, "greatest number of samples"),
        MaxDepthParameter(&o.max_depth)};
  }
  std::optional<Effort> EffortOption() const override { return Effort{"max_iterations", true}; }
  std::unique_ptr<MotionEstimator> Make() const override { return std::make_unique<OpenCvUsac>(options_); }

 private:
  UsacOptions options_;
};

}  // namespace

std::unique_ptr<EstimatorModel> OpenCvUsacModel() { return std::make_unique<UsacModel>(); }

}  // namespace rcme
