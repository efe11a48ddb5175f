#include "experiments/audit/validity/sample_family.h"

#include <fmt/format.h>

#include "simulator/noise/noise_laws.h"
#include "simulator/observe.h"

namespace rcme {

SampleFamily::SampleFamily(int num_points, double baseline_m, double sigma_px)
    : scenes_("uniform_volume"), sigma_px_(sigma_px) {
  const std::vector<Parameter> parameters = scenes_.Parameters();
  FindParameter(parameters, "num_matches").SetFromText(fmt::format("{}", num_points + 1));
  FindParameter(parameters, "baseline_m").SetFromText(fmt::format("{}", baseline_m));
}

Scene SampleFamily::MakeScene(const StreamName& name) const {
  RandomStream scene_rng = StreamFor(name, StreamPurpose::kScene);
  return scenes_.Generate(scene_rng);
}

ObservedSample SampleFamily::Observe(const Scene& scene, const StreamName& name,
                                     RandomStream& noise_rng) const {
  return ObserveWith(sigma_px_, scene, name, noise_rng);
}

ObservedSample SampleFamily::ObserveExactly(const Scene& scene, const StreamName& name) const {
  RandomStream unused = StreamFor(name, StreamPurpose::kNoise);  // the noise is multiplied by zero
  return ObserveWith(0.0, scene, name, unused);
}

ObservedSample SampleFamily::ObserveWith(double noise_px, const Scene& scene, const StreamName& name,
                                         RandomStream& noise_rng) const {
  // there are no outliers: only for the order
  RandomStream order_rng = StreamFor(name, StreamPurpose::kOutliers);
  Observation observation =
      rcme::Observe(scene, *MakeGaussianNoise(noise_px), OutlierModel(0.0), noise_rng, order_rng);
  ObservedSample sample;
  sample.fresh_match = observation.matches.back();
  observation.matches.pop_back();
  sample.problem = {std::move(observation.matches), scene.camera1, scene.camera2, sigma_px_};
  return sample;
}

double ParallaxRad(const Scene& scene, const Eigen::Vector3d& point_in_cam1) {
  return AngleBetween(scene.cam2_from_cam1_true.R * point_in_cam1, scene.InCamera2(point_in_cam1));
}

}  // namespace rcme
