#include "experiments/simulated_data.h"

#include "simulator/observe.h"

namespace rcme {

std::vector<Parameter> SimulatedData::Parameters() {
  std::vector<Parameter> all = scene_->Parameters();
  for (const std::vector<Parameter>& more : {rcme::Parameters(noise_), rcme::Parameters(outliers_)}) {
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

Scene SimulatedData::DrawScene(const StreamName& trial_name) const {
  RandomStream scene_rng = StreamFor(trial_name, StreamPurpose::kScene);
  return scene_->Generate(scene_rng);
}

TrialData SimulatedData::MakeFrom(const Scene& scene, const StreamName& trial_name) const {
  RandomStream noise_rng = StreamFor(trial_name, StreamPurpose::kNoise);
  RandomStream outlier_rng = StreamFor(trial_name, StreamPurpose::kOutliers);
  Observation observation = Observe(scene, noise_, outliers_, noise_rng, outlier_rng);

  TrialData data;
  data.problem = {std::move(observation.matches), scene.camera1, scene.camera2, noise_.sigma_px};
  data.truth = {scene.cam2_from_cam1_true, true, std::move(observation.is_inlier_true)};
  data.origin = "simulated";
  return data;
}

}  // namespace rcme
