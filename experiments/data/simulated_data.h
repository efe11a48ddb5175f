#pragma once

#include <memory>
#include <mutex>
#include <span>
#include <string>

#include "experiments/data/data_source.h"
#include "simulator/calibration_error.h"
#include "simulator/camera_defects.h"
#include "simulator/motion_sensors.h"
#include "simulator/noise_model.h"
#include "simulator/observe.h"
#include "simulator/outlier_model.h"
#include "simulator/scene_generator.h"

namespace rcme {

// The parts of a simulation that a study chooses by name; each has parameters of its own. Empty: the scene's
// usual cameras and motion, gaussian noise, uniform outliers.
struct Choices {
  std::string scene, cameras, motion, noise, outliers;
};

// Simulated pairs: a scene, noise and outliers. The estimators get only the matches, an assumed sigma and
// assumed cameras. Throws NotSimulated if the settings do not allow a scene or its images.
class SimulatedData : public DataSource {
 public:
  // Throws InputError that lists what is allowed.
  explicit SimulatedData(const Choices& choices);
  std::vector<Parameter> Parameters();
  // The parameters that shape the scene; the others concern its images.
  std::vector<Parameter> SceneParameters() { return scenes_.Parameters(); }

  // See SceneGenerator. The first scene calls it if nobody has; set no parameter afterwards. Throws at every
  // call if no baseline gives the parallax.
  void FixBaseline() const;
  // The baseline, if it was found from a parallax.
  std::string Identity() const override;
  Settings ChosenParts() const override;

  int NumTrials(int trials) const override { return trials; }
  TrialData Make(const StreamName& trial_name) const override;

  std::optional<Scene> FindScene(const StreamName& trial_name) const override {
    return DrawScene(trial_name);
  }

  // The two steps of Make: the exact scene, and its images.
  Scene DrawScene(const StreamName& trial_name) const;
  TrialData MakeFrom(const Scene& scene, const StreamName& trial_name) const;

  // Draws another scene with the same motion, or with a motion near it (MotionModel::DrawNear).
  // DrawSceneNear returns nothing if the motion's law has no such move.
  Scene DrawSceneWithMotion(const Motion& motion, RandomStream& rng) const;
  std::optional<Scene> DrawSceneNear(const Motion& motion, double step, RandomStream& rng) const;

  // The rms of the noise over the coordinates of matches, from the noise law.
  double sigma_px() const { return noise_->sigma_px(); }
  // Returns whether the noise is sigma_px times standard normal numbers (`noise: gaussian`).
  bool HasNormalNoise() const { return choices_.noise == "gaussian"; }
  bool HasRollingShutter() const { return defects_.rolling_shutter != 0.0; }
  // The second step with given standard normal numbers, four per point of the scene (x1, y1, x2, y2).
  // Outliers, then the noise of priors, are drawn from `outlier_rng`. Severity is not measured.
  TrialData MakeFrom(const Scene& scene, std::span<const double> normals, RandomStream& outlier_rng) const;

 private:
  Lens AssumedLens(const SceneCamera& camera_true) const;
  // Undistorts the matches. Matches at a pixel that no ray reaches, because of noise or a wrong assumed K,
  // are left out, as `rcme pairs` leaves out key points. prior_rng is for the sensors; without sensors
  // nothing is drawn.
  TrialData Give(const Scene& scene, Observation observation, RandomStream& prior_rng) const;

  Choices choices_;                // none is empty
  mutable SceneGenerator scenes_;  // changed by FixBaseline
  mutable std::once_flag baseline_once_;
  mutable std::string baseline_error_;  // empty: no error
  std::unique_ptr<NoiseModel> noise_;
  OutlierModel outliers_;
  CameraDefects defects_;
  CalibrationError assumed_;
  MotionSensors sensors_;
  bool measures_severity_ = true;
};

}  // namespace rcme
