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
  TrialData Make(const StreamName& trial_name) const override;

 private:
  std::unique_ptr<SceneModel> scene_;
  NoiseModel noise_;
  OutlierModel outliers_;
};

}  // namespace rcme
