#pragma once

#include <memory>

#include "experiments/data_source.h"
#include "simulator/noise_model.h"
#include "simulator/outlier_model.h"
#include "simulator/scene.h"

namespace rcme {

// Simulated pairs: a scene, noise, outliers. The estimators are told the true sigma and nothing else.
class SimulatedData : public DataSource {
 public:
  explicit SimulatedData(std::unique_ptr<SceneModel> scene) : scene_(std::move(scene)) {}
  std::vector<Parameter> Parameters();

  int NumTrials(int trials) const override { return trials; }
  TrialData Make(const StreamName& trial_name) const override {
    return MakeFrom(DrawScene(trial_name), trial_name);
  }

  // The two halves of Make: the exact scene, and what the images give of it.
  Scene DrawScene(const StreamName& trial_name) const;
  TrialData MakeFrom(const Scene& scene, const StreamName& trial_name) const;

 private:
  std::unique_ptr<SceneModel> scene_;
  NoiseModel noise_;
  OutlierModel outliers_;
};

// Simulated data for the settings, `scene` among them. Throws InputError that names key and value.
std::shared_ptr<const SimulatedData> MakeSimulatedData(const Settings& settings);

}  // namespace rcme
