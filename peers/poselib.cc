// PoseLib's relative pose: LO-RANSAC over five-point samples, then refinement over the inliers. PoseLib is
// not a Debian package; this is built if CMake finds it.
#include "peers/peer_call.h"
#include "peers/peers.h"
#include "peers/poselib_options.h"

namespace rcme {
namespace {

// The type of the options of estimate_relative_pose: RansacOptions (followed by BundleOptions) up to 2.0.5,
// later RelativePoseOptions, which contain both.
template <typename Points, typename PoseLibCamera, typename Options, typename... Rest>
Options DeduceOptions(poselib::RansacStats (*)(const Points&, const Points&, const PoseLibCamera&,
                                               const PoseLibCamera&, const Options&, Rest...));
using CallOptions = decltype(DeduceOptions(&poselib::estimate_relative_pose));

// PoseLib compares the threshold with the Sampson distance in pixels of the mean focal length, whose standard
// deviation is sigma.
template <typename Options>
Options OptionsFor(const PoseLibOptions& options, double sigma_px, std::uint32_t seed) {
  Options call;
  const double threshold_px = options.threshold_sigma * sigma_px;
  if constexpr (requires { call.max_epipolar_error; }) {
    call.max_epipolar_error = threshold_px;
    SetStoppingRule(options, seed, &call);
  } else {
    call.max_error = threshold_px;
    SetStoppingRule(options, seed, &call.ransac);
  }
  return call;
}

template <typename Options, typename... Arguments>
auto Call(const Options& options, poselib::CameraPose* pose, std::vector<char>* inliers,
          const Arguments&... points_and_cameras) {
  if constexpr (requires { options.max_epipolar_error; }) {
    return poselib::estimate_relative_pose(points_and_cameras..., options, {}, pose, inliers);
  } else {
    return poselib::estimate_relative_pose(points_and_cameras..., options, pose, inliers);
  }
}

class PoseLib : public MotionEstimator {
 public:
  explicit PoseLib(const PoseLibOptions& options) : options_(options) {}

  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override {
    return CallPeer(problem, 5, "PoseLib", [&] { return Ask(problem, rng); });
  }

 private:
  std::optional<PeerAnswer> Ask(const MotionProblem& problem, RandomStream& rng) const {
    std::vector<poselib::Point2D> points1, points2;
    for (const Correspondence& match : problem.matches) {
      points1.push_back(match.x1_px);
      points2.push_back(match.x2_px);
    }
    poselib::CameraPose pose;
    std::vector<char> is_inlier;
    const auto options = OptionsFor<CallOptions>(options_, problem.sigma_px, rng.Next32());
    const auto stats = Call(options, &pose, &is_inlier, points1, points2, MakePoseLibCamera(problem.camera1),
                            MakePoseLibCamera(problem.camera2));
    if (stats.num_inliers == 0) return std::nullopt;
    PeerAnswer answer{{pose.R(), pose.t.normalized()}, {}};
    for (size_t i = 0; i < is_inlier.size(); ++i) {
      if (is_inlier[i]) answer.inliers.push_back(static_cast<int>(i));
    }
    return answer;
  }

  PoseLibOptions options_;
};

class PoseLibEstimatorModel : public EstimatorModel {
 public:
  std::vector<Parameter> Parameters() override { return rcme::Parameters(options_); }
  std::optional<Effort> EffortOption() const override { return Effort{"max_iterations", true}; }
  std::unique_ptr<MotionEstimator> Make() const override { return MakePoseLib(options_); }

 private:
  PoseLibOptions options_;
};

}  // namespace

std::vector<Parameter> Parameters(PoseLibOptions& o) {
  return {Parameter::Real("threshold_sigma", &o.threshold_sigma, {1e-3, 1e3}, "sigma",
                          "inlier threshold in standard deviations of the distance"),
          Parameter::Real("confidence", &o.confidence, {0.01, 0.999999}, "",
                          "probability of a sample without wrong matches at which the loop ends"),
          Parameter::Integer("min_iterations", &o.min_iterations, {0, 1e6},
                             "least number of samples, up to max_iterations"),
          Parameter::Integer("max_iterations", &o.max_iterations, {1, 1e6}, "greatest number of samples")};
}

poselib::Camera MakePoseLibCamera(const Camera& camera) {
  return {"PINHOLE", {camera.fx, camera.fy, camera.cx, camera.cy}, camera.width, camera.height};
}

std::unique_ptr<MotionEstimator> MakePoseLib(const PoseLibOptions& options) {
  return std::make_unique<PoseLib>(options);
}

std::unique_ptr<EstimatorModel> PoseLibModel() { return std::make_unique<PoseLibEstimatorModel>(); }

}  // namespace rcme
