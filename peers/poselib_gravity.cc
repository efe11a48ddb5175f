// PoseLib's solver for three matches and the direction of gravity, in PoseLib's RANSAC. PoseLib has no call
// for it: this does what its estimate_relative_pose does with five matches, with samples of three. Gravity is
// taken as exact, and the refinement does not use it. Without gravity this is the estimator poselib. Needs
// PoseLib 3; built if CMake finds it.
#include <PoseLib/robust/bundle.h>
#include <PoseLib/robust/estimators/relative_pose.h>
#include <PoseLib/robust/ransac_impl.h>
#include <PoseLib/robust/utils.h>
#include <PoseLib/solvers/relpose_upright_3pt.h>

#include "peers/peer_call.h"
#include "peers/peers.h"
#include "peers/poselib_options.h"

namespace rcme {
namespace {

using Points = std::vector<poselib::Point2D>;

// Models, scores and refinements for poselib::ransac; the names of the members are PoseLib's.
class UprightEstimator {
 public:
  // Points in the image plane at depth 1.
  UprightEstimator(const poselib::RelativePoseOptions& options, const Points& points1, const Points& points2,
                   const GravityPrior& gravity)
      : num_data(points1.size()),
        points1_(points1),
        points2_(points2),
        gravity_(gravity),
        scores_(options, points1, points2),
        sampler_(num_data, sample_sz, options.ransac),
        sample_(sample_sz) {}

  void generate_models(poselib::CameraPoseVector* models) {
    sampler_.generate_sample(&sample_);
    std::vector<Eigen::Vector3d> rays1, rays2;
    for (const std::size_t match : sample_) {
      rays1.push_back(points1_[match].homogeneous().normalized());
      rays2.push_back(points2_[match].homogeneous().normalized());
    }
    poselib::relpose_upright_3pt(rays1, rays2, gravity_.in_cam1, gravity_.in_cam2, models);
  }
  double score_model(const poselib::CameraPose& pose, std::size_t* inlier_count) const {
    return scores_.score_model(pose, inlier_count);
  }
  void refine_model(poselib::CameraPose* pose) const { scores_.refine_model(pose); }

  const std::size_t sample_sz = 3;
  const std::size_t num_data;

 private:
  const Points &points1_, &points2_;
  const GravityPrior& gravity_;
  poselib::RelativePoseEstimator scores_;
  poselib::RandomSampler sampler_;
  std::vector<std::size_t> sample_;
};

Points Unproject(const std::vector<Correspondence>& matches, const Camera& camera,
                 Eigen::Vector2d Correspondence::*point_px) {
  Points points;
  for (const Correspondence& match : matches) points.push_back(camera.Ray(match.*point_px).hnormalized());
  return points;
}

Points SelectInliers(const Points& points, const std::vector<int>& inliers) {
  Points selected;
  for (const int i : inliers) selected.push_back(points[static_cast<std::size_t>(i)]);
  return selected;
}

class PoseLibGravity : public MotionEstimator {
 public:
  explicit PoseLibGravity(const PoseLibOptions& options)
      : options_(options), five_points_(MakePoseLib(options)) {}

  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override {
    if (!problem.prior || !problem.prior->gravity) return five_points_->Estimate(problem, rng);
    return CallPeer(problem, 3, "PoseLib", [&] { return Ask(problem, *problem.prior->gravity, rng); });
  }

 private:
  std::optional<PeerAnswer> Ask(const MotionProblem& problem, const GravityPrior& gravity,
                                RandomStream& rng) const {
    constexpr std::size_t kMinimal = 5;  // matches that the refinement needs more than
    const double pixel = 0.5 * (1.0 / MakePoseLibCamera(problem.camera1).focal() +
                                1.0 / MakePoseLibCamera(problem.camera2).focal());
    poselib::RelativePoseOptions options;
    options.max_error = options_.threshold_sigma * problem.sigma_px * pixel;
    options.bundle.loss_scale *= pixel;
    SetStoppingRule(options_, rng.Next32(), &options.ransac);
    const Points points1 = Unproject(problem.matches, problem.camera1, &Correspondence::x1_px);
    const Points points2 = Unproject(problem.matches, problem.camera2, &Correspondence::x2_px);
    UprightEstimator estimator(options, points1, points2, gravity);
    poselib::CameraPose pose;
    if (poselib::ransac(estimator, options.ransac, &pose).num_inliers == 0) return std::nullopt;
    std::vector<char> is_inlier;
    poselib::get_inliers(pose, points1, points2, options.max_error * options.max_error, &is_inlier);
    PeerAnswer answer;
    for (std::size_t i = 0; i < is_inlier.size(); ++i) {
      if (is_inlier[i]) answer.inliers.push_back(static_cast<int>(i));
    }
    if (answer.inliers.size() > kMinimal) {
      poselib::refine_relpose(SelectInliers(points1, answer.inliers), SelectInliers(points2, answer.inliers),
                              &pose, options.bundle);
    }
    answer.cam2_from_cam1 = {pose.R(), pose.t.normalized()};
    return answer;
  }

  PoseLibOptions options_;
  std::unique_ptr<MotionEstimator> five_points_;
};

class PoseLibGravityEstimatorModel : public EstimatorModel {
 public:
  std::vector<Parameter> Parameters() override { return rcme::Parameters(options_); }
  std::optional<Effort> EffortOption() const override { return Effort{"max_iterations", true}; }
  std::unique_ptr<MotionEstimator> Make() const override {
    return std::make_unique<PoseLibGravity>(options_);
  }

 private:
  PoseLibOptions options_;
};

}  // namespace

std::unique_ptr<EstimatorModel> PoseLibGravityModel() {
  return std::make_unique<PoseLibGravityEstimatorModel>();
}

}  // namespace rcme
