// Draws the scene of a trial: motion, world, and points that both cameras see.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "simulator/camera_model.h"
#include "simulator/motion_model.h"
#include "simulator/scene.h"
#include "simulator/scene_model.h"

namespace rcme {

// Const and shared by threads once the parameters are set.
class SceneGenerator {
 public:
  // Takes names from the registries; an empty name means the scene's default. Throws InputError that lists
  // the known names.
  explicit SceneGenerator(const std::string& scene, const std::string& cameras = "",
                          const std::string& motion = "");

  const std::string& cameras() const { return cameras_name_; }
  const std::string& motion() const { return motion_name_; }

  // num_matches and the parameters of scene, cameras and motion.
  std::vector<Parameter> Parameters();
  // If the baseline is given as parallax: fixes the baseline such that the median parallax of a scene's
  // points has this value on average over pilot scenes. These are drawn from the streams that `pilot` names,
  // one per trial. Call it once all parameters are set, before the first scene. Throws InputError if no
  // baseline gives this parallax.
  void FixBaseline(const StreamName& pilot);
  // The baseline that FixBaseline has found; NaN if the length is not given as parallax.
  double BaselineOfParallax() const;

  // Draws one scene from its own stream (the number of draws varies). Throws InputError that names the keys
  // if the parameters admit no such scene.
  Scene Generate(RandomStream& rng) const { return Generate(num_matches_, rng); }
  // Draws a scene with this motion.
  Scene GenerateWith(const Motion& motion, RandomStream& rng) const {
    return GenerateWith(motion, num_matches_, rng);
  }
  const MotionModel& motion_model() const { return *motion_; }

 private:
  // Mean over the pilot scenes of the median parallax of the points. Throws InputError if one cannot be
  // drawn.
  double MeanParallaxDeg(const StreamName& pilot) const;
  Scene Generate(int num_matches, RandomStream& rng) const;
  Scene GenerateWith(const Motion& motion, int num_matches, RandomStream& rng) const;
  void DrawPart(const World& world, size_t part, size_t num_points, RandomStream& rng, Scene* scene) const;

  std::string scene_name_, cameras_name_, motion_name_;
  std::unique_ptr<SceneModel> scene_;
  std::unique_ptr<CameraModel> cameras_;
  std::unique_ptr<MotionModel> motion_;
  std::string keys_;  // all keys, for messages
  int num_matches_ = 500;
};

}  // namespace rcme
