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

// What a study chooses by name; each choice brings parameters of its own. Empty: the scene's usual cameras
// and motion, gaussian noise, uniform outliers.
struct Choices {
  std::string scene, cameras, motion, noise, outliers;
};

// Simulated pairs: a scene, noise, outliers. The estimators get the matches, an assumed sigma and assumed
// cameras, and nothing else. Scenes and what the images give of them throw NotSimulated where the settings do
// not allow them.
class SimulatedData : public DataSource {
 public:
  // Throws InputError that lists what is allowed.
  explicit SimulatedData(const Choices& choices);
  std::vector<Parameter> Parameters();
  // Those that shape the scene: the others say what the images give of it.
  std::vector<Parameter> SceneParameters() { return scenes_.Parameters(); }

  // See SceneGenerator. The first scene does it where nobody has called it; no parameter is set afterwards.
  // Throws at every call if no baseline gives the parallax.
  void FixBaseline() const;
  // The baseline, where it was found from a parallax.
  std::string Identity() const override;
  Settings ChosenParts() const override;

  int NumTrials(int trials) const override { return trials; }
  TrialData Make(const StreamName& trial_name) const override;

  std::optional<Scene> FindScene(const StreamName& trial_name) const override {
    return DrawScene(trial_name);
  }

  // The two halves of Make: the exact scene, and what the images give of it.
  Scene DrawScene(const StreamName& trial_name) const;
  TrialData MakeFrom(const Scene& scene, const StreamName& trial_name) const;

  // Another scene of the same motion, or of one near it (MotionModel::DrawNear): nothing where the motion's
  // law has no such move.
  Scene DrawSceneWithMotion(const Motion& motion, RandomStream& rng) const;
  std::optional<Scene> DrawSceneNear(const Motion& motion, double step, RandomStream& rng) const;

  // Root mean square of the noise over the coordinates of matches, as the noise's law has it.
  double sigma_px() const { return noise_->sigma_px(); }
  // Whether the noise is sigma_px times standard normal numbers (`noise: gaussian`).
  bool HasNormalNoise() const { return choices_.noise == "gaussian"; }
  bool HasRollingShutter() const { return defects_.rolling_shutter != 0.0; }
  // The second half with these numbers, four for each point of the scene (x1, y1, x2, y2), and outliers from
  // a stream of one's own, then the noise of priors. Severity is not measured.
  TrialData MakeFrom(const Scene& scene, std::span<const double> normals, RandomStream& outlier_rng) const;

 private:
  Lens AssumedLens(const SceneCamera& camera_true) const;
  // Matches are undistorted; those at a pixel that no ray reaches, by noise or in the eyes of who assumes
  // another K, are left out, as `rcme pairs` leaves out key points.
  // prior_rng: of the sensors, which draw nothing where there are none.
  TrialData Give(const Scene& scene, Observation observation, RandomStream& prior_rng) const;

  Choices choices_;                // none empty
  mutable SceneGenerator scenes_;  // FixBaseline
  mutable std::once_flag baseline_once_;
  mutable std::string baseline_error_;  // empty: none
  std::unique_ptr<NoiseModel> noise_;
  OutlierModel outliers_;
  CameraDefects defects_;
  CalibrationError assumed_;
  MotionSensors sensors_;
  bool measures_severity_ = true;
};

}  // namespace rcme
