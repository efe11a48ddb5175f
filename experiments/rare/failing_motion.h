// A trial as a system for multilevel splitting (stats/splitting.h): its random inputs as a state, moves that
// leave their law as it is, and how near the estimator is to a rare event.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "experiments/rare/rare_event.h"
#include "experiments/study/study_plan.h"
#include "experiments/trial/trial.h"

namespace rcme {

class SimulatedData;

// Of the streams of splitting, beside the purposes of a trial's streams (StreamPurpose).
inline constexpr std::uint32_t kSplittingPurpose = 100;

// The random inputs of a trial: all that decides whether the event happens.
struct MotionInputs {
  std::shared_ptr<const Scene> scene;                 // null: it could not be simulated
  std::vector<double> noise;                          // standard normal, four for each point of the scene
  std::uint64_t outlier_seed = 0, sampling_seed = 0;  // name the streams of outliers and samples
};

// Throws InputError for a study on match files: scene, noise and outliers of real pairs cannot be drawn
// again.
void RequireDrawnScenes(const Study& study);

class FailingMotion {
 public:
  using State = MotionInputs;

  // One condition of the plan, one of its estimators. Throws InputError that names key and value:
  // match files; noise that is not normal; trials with weights.
  FailingMotion(const StudyPlan& plan, const Condition& condition, size_t estimator,
                const RareEvent& event = {});

  // Of the first kNumTried draws of a condition of a population; not simulated if it is all of them. The law
  // is that of the trials that can be simulated: draws are repeated until one can, and moves to others not
  // made.
  static constexpr int kNumTried = 1000;
  int num_not_simulated() const { return num_not_simulated_; }
  const std::string& why_not_simulated() const { return why_not_simulated_; }  // the first of them

  // The law of a trial of the condition, with random numbers that no trial of a run has. Not if none could be
  // simulated.
  State Draw(RandomStream& rng) const;

  // Of sixteen moves eight are of the noise, local, preconditioned Crank-Nicolson: sqrt(1 - step^2) z + step
  // z' with fresh normals z' keeps the law of z. Where points are independent given the motion
  // (uniform_volume), two renew each of them with probability step^2 / 2 and two move the motion; elsewhere
  // these are moves of the noise too. Two renew the outliers, one the scene, one the samples, whole.
  State Propose(const State& state, double step, RandomStream& rng, bool& is_local) const;

  // ComputeNearness of the estimator's answer to the event. Below all others where the state cannot be
  // simulated.
  double Value(const State& state) const;

 private:
  State DrawOnce(RandomStream& rng) const;
  TrialData MakeData(const State& state) const;
  void TryDraws(RandomStream& rng);
  std::shared_ptr<const Scene> ProposeScene(const State& state, std::uint32_t kind, double step,
                                            RandomStream& rng) const;
  std::shared_ptr<const Scene> DrawScene(RandomStream& rng) const;
  std::shared_ptr<const Scene> WithSomePoints(const Scene& scene, double share, RandomStream& rng) const;
  std::shared_ptr<const Scene> WithMotionNear(const Scene& scene, double step, RandomStream& rng) const;

  std::shared_ptr<const SimulatedData> data_;
  std::shared_ptr<const MotionEstimator> estimator_;
  Study study_;
  RareEvent event_;
  std::uint64_t stream_key_;
  bool has_free_points_ = false;  // given the motion they are independent
  int num_not_simulated_ = 0;
  std::string why_not_simulated_;
};

}  // namespace rcme
