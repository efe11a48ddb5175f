// OpenGV's RANSAC for the motion of two central cameras, with its nonlinear refinement.
#include <memory>
#include <opengv/relative_pose/CentralRelativeAdapter.hpp>
#include <opengv/sac/Ransac.hpp>
#include <opengv/sac_problems/relative_pose/CentralRelativePoseSacProblem.hpp>

#include "peers/peer_call.h"
#include "peers/peers.h"

namespace rcme {
namespace {

using SacProblem = opengv::sac_problems::relative_pose::CentralRelativePoseSacProblem;

enum class OpenGvRefinement { kNone, kNonlinear };

// Defaults are those of opengv::sac::SampleConsensus and of its examples.
struct OpenGvOptions {
  SacProblem::Algorithm algorithm = SacProblem::NISTER;
  OpenGvRefinement refinement = OpenGvRefinement::kNonlinear;
  double threshold_sigma = 2.0;
  double confidence = 0.99;
  int max_iterations = 1000;
};

// The squared angle of a pixel (rad^2), the mean over both axes and the image. A step of one pixel moves the
// ray r = (x, y, 1) by (1 / fx, 0, 0) or (0, 1 / fy, 0). The angle is the part normal to the ray over |r|;
// its square is (1 + y^2) / (fx^2 |r|^4) or (1 + x^2) / (fy^2 |r|^4).
double SquaredAngleOfPixel(const Camera& camera) {
  constexpr int kCells = 8;
  double sum = 0.0;
  for (int row = 0; row < kCells; ++row) {
    for (int col = 0; col < kCells; ++col) {
      const Eigen::Vector3d ray =
          camera.Ray({(col + 0.5) / kCells * camera.width - 0.5, (row + 0.5) / kCells * camera.height - 0.5});
      const double x2 = ray.x() * ray.x(), y2 = ray.y() * ray.y(), length2 = ray.squaredNorm();
      sum += ((1.0 + y2) / (camera.fx * camera.fx) + (1.0 + x2) / (camera.fy * camera.fy)) /
             (2.0 * length2 * length2);
    }
  }
  return sum / (kCells * kCells);
}

// OpenGV compares the threshold with (1 - cos a1) + (1 - cos a2), for small angles (a1^2 + a2^2) / 2, a1 and
// a2 the angles between the rays of a match and of its triangulated point. The least a1^2 + a2^2 moves both
// rays along the normals of their epipolar planes: e^2 / (|n1|^2 + |n2|^2) in unit rays, e the constraint, n1
// and n2 its gradients. Noise of sigma px turns ray k by s_k rad, so the variance of e is s_1^2 |n1|^2 +
// s_2^2 |n2|^2. If both gradients have the same length, the least angle sqrt(a1^2 + a2^2) has standard
// deviation s with s^2 = (s_1^2 + s_2^2) / 2, and k standard deviations correspond to the threshold (k s)^2 /
// 2.
double Threshold(const OpenGvOptions& options, const MotionProblem& problem) {
  const double in_px = options.threshold_sigma * problem.sigma_px;
  return 0.25 * in_px * in_px * (SquaredAngleOfPixel(problem.camera1) + SquaredAngleOfPixel(problem.camera2));
}

// Draws OpenGV's samples from our random stream, since OpenGV seeds its own generator by the clock or with a
// constant.
class StreamSacProblem : public SacProblem {
 public:
  StreamSacProblem(adapter_t& adapter, Algorithm algorithm, RandomStream& rng)
      : SacProblem(adapter, algorithm, /*randomSeed=*/false), rng_(rng) {}

  void getSamples(int& /*iterations*/, std::vector<int>& sample) override {
    std::vector<int>& pool = shuffled_indices_;
    for (size_t i = 0; i < static_cast<size_t>(getSampleSize()); ++i) {
      std::swap(pool[i], pool[i + rng_.IntegerBelow(static_cast<std::uint32_t>(pool.size() - i))]);
    }
    sample.assign(pool.begin(), pool.begin() + getSampleSize());
  }

 private:
  RandomStream& rng_;
};

// Size of a sample: the solver's matches, and two or three more with which OpenGV selects among its models.
int SampleSize(SacProblem::Algorithm algorithm) {
  return algorithm == SacProblem::NISTER || algorithm == SacProblem::STEWENIUS ? 8 : 9;
}

// OpenGV's motion is the pose of camera 2 in camera 1: X1 = R12 X2 + t12, with arbitrary |t12|.
RelativePose PoseFrom(const opengv::transformation_t& cam1_from_cam2) {
  const Eigen::Matrix3d R = cam1_from_cam2.leftCols<3>().transpose();
  return {R, (-R * cam1_from_cam2.col(3)).normalized()};
}

class OpenGvRansac : public MotionEstimator {
 public:
  explicit OpenGvRansac(const OpenGvOptions& options) : options_(options) {}

  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override {
    return CallPeer(problem, SampleSize(options_.algorithm), "OpenGV", [&] { return Ask(problem, rng); });
  }

 private:
  std::optional<PeerAnswer> Ask(const MotionProblem& problem, RandomStream& rng) const {
    opengv::bearingVectors_t rays1, rays2;
    for (const Correspondence& match : problem.matches) {
      rays1.push_back(problem.camera1.Ray(match.x1_px).normalized());
      rays2.push_back(problem.camera2.Ray(match.x2_px).normalized());
    }
    opengv::relative_pose::CentralRelativeAdapter adapter(rays1, rays2);
    const auto sac = std::make_shared<StreamSacProblem>(adapter, options_.algorithm, rng);
    const double threshold = Threshold(options_, problem);
    opengv::sac::Ransac<SacProblem> ransac(options_.max_iterations, threshold, options_.confidence);
    ransac.sac_model_ = sac;
    if (!ransac.computeModel()) return std::nullopt;
    opengv::transformation_t motion = ransac.model_coefficients_;
    std::vector<int> inliers = ransac.inliers_;
    if (options_.refinement == OpenGvRefinement::kNonlinear && !inliers.empty()) {
      sac->optimizeModelCoefficients(inliers, ransac.model_coefficients_, motion);
      sac->selectWithinDistance(motion, threshold, inliers);
    }
    if (inliers.empty()) return std::nullopt;
    return PeerAnswer{PoseFrom(motion), inliers};
  }

  OpenGvOptions options_;
};

class OpenGvModel : public EstimatorModel {
 public:
  std::vector<Parameter> Parameters() override {
    OpenGvOptions& o = options_;
    return {Parameter::Choice(
                "algorithm", &o.algorithm,
                {{"five_point_nister", SacProblem::NISTER},
                 {"five_point_stewenius", SacProblem::STEWENIUS},
                 {"seven_point", SacProblem::SEVENPT},
                 {"eight_point", SacProblem::EIGHTPT}},
                "minimal solver; a sample has one to three more matches to choose among its models"),
            Parameter::Choice(
                "refinement", &o.refinement,
                {{"none", OpenGvRefinement::kNone}, {"nonlinear", OpenGvRefinement::kNonlinear}},
                "of the best hypothesis over its inliers, chosen again afterwards; OpenGV sums fourth powers "
                "of distances"),
            Parameter::Real("threshold_sigma", &o.threshold_sigma, {1e-3, 1e3}, "sigma",
                            "inlier threshold in standard deviations of the distance"),
            Parameter::Real("confidence", &o.confidence, {0.01, 0.999999}, "",
                            "probability of a sample without wrong matches at which the loop ends"),
            Parameter::Integer("max_iterations", &o.max_iterations, {1, 1e6}, "greatest number of samples")};
  }
  std::optional<Effort> EffortOption() const override { return Effort{"max_iterations", true}; }
  std::unique_ptr<MotionEstimator> Make() const override { return std::make_unique<OpenGvRansac>(options_); }

 private:
  OpenGvOptions options_;
};

}  // namespace

std::unique_ptr<EstimatorModel> OpenGvRansacModel() { return std::make_unique<OpenGvModel>(); }

}  // namespace rcme
