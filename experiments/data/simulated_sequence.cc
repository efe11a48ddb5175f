#include "experiments/data/simulated_sequence.h"

#include <cmath>
#include <utility>

namespace rcme {
namespace {

// The pose of an image relative to the first: X_image = R X_0 + t, t in metres.
struct ImagePose {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t = Eigen::Vector3d::Zero();

  Eigen::Vector3d Map(const Eigen::Vector3d& point) const { return R * point + t; }
};

std::vector<ImagePose> RepeatMotion(const Scene& scene, int num_images) {
  const Eigen::Matrix3d& R = scene.cam2_from_cam1_true.R;
  const Eigen::Vector3d t = scene.baseline_m * scene.cam2_from_cam1_true.t;
  std::vector<ImagePose> poses(1);
  while (std::ssize(poses) < num_images) {
    const ImagePose& last = poses.back();
    poses.push_back({R * last.R, R * last.t + t});
  }
  return poses;
}

ViewPair MakeView(const Scene& scene, const ImagePose& pose1, const ImagePose& pose2) {
  const Eigen::Matrix3d R = pose2.R * pose1.R.transpose();
  const Eigen::Vector3d t = pose2.t - R * pose1.t;
  const double baseline_m = t.norm();
  const Eigen::Vector3d direction =
      baseline_m > 0.0 ? Eigen::Vector3d(t / baseline_m) : Eigen::Vector3d::UnitX();
  return {scene.camera1, scene.camera1, {R, direction}, baseline_m};
}

void RoundCoordinates(std::vector<Correspondence>* matches) {
  const auto round = [](double x_px) { return std::round(x_px * 1e6) / 1e6; };
  for (Correspondence& match : *matches) {
    match.x1_px = match.x1_px.unaryExpr(round);
    match.x2_px = match.x2_px.unaryExpr(round);
  }
}

}  // namespace

std::vector<SequencePair> SimulateSequence(const SimulatedData& data, const StreamName& trial_name,
                                           int num_images) {
  if (!data.HasNormalNoise())
    throw InputError("noise: a sequence of images needs gaussian noise, one error for each key point");
  if (data.HasRollingShutter())
    throw InputError("rolling_shutter: not simulated in a sequence of images; leave it out");
  const Scene scene = data.DrawScene(trial_name);
  const size_t num_points = scene.points_in_cam1.size();
  const std::vector<ImagePose> poses = RepeatMotion(scene, num_images);
  RandomStream noise_rng = StreamFor(trial_name, StreamPurpose::kNoise),
               outlier_rng = StreamFor(trial_name, StreamPurpose::kOutliers);
  std::vector<double> noise(2 * num_points * poses.size());  // x, y of each point in each image
  noise_rng.FillNormal(noise);

  const auto make_pair = [&](size_t image1, size_t image2) -> SequencePair {
    Scene seen;
    static_cast<ViewPair&>(seen) = MakeView(scene, poses[image1], poses[image2]);
    for (const Eigen::Vector3d& step_m : scene.repeat_steps_m)
      seen.repeat_steps_m.push_back(poses[image1].R * step_m);
    std::vector<double> of_seen;  // x1, y1, x2, y2 of each point
    for (size_t i = 0; i < num_points; ++i) {
      const Eigen::Vector3d point = poses[image1].Map(scene.points_in_cam1[i]);
      if (!seen.Sees(point)) continue;
      seen.points_in_cam1.push_back(point);
      for (const size_t image : {image1, image2}) {
        const double* error = &noise[2 * (image * num_points + i)];
        of_seen.insert(of_seen.end(), {error[0], error[1]});
      }
    }
    SequencePair pair{static_cast<int>(image1), static_cast<int>(image2), {}};
    if (seen.points_in_cam1.size() < kLeastSequencePoints) return pair;
    pair.data = data.MakeFrom(seen, of_seen, outlier_rng);
    RoundCoordinates(&pair.data.problem.matches);
    return pair;
  };
  std::vector<SequencePair> pairs;
  const auto add = [&](size_t image1, size_t image2) {
    SequencePair pair = make_pair(image1, image2);
    if (!pair.data.problem.matches.empty()) pairs.push_back(std::move(pair));
  };
  for (size_t image = 1; image < poses.size(); ++image) {
    add(image - 1, image);
    if (image > 1) add(0, image);
  }
  return pairs;
}

}  // namespace rcme
