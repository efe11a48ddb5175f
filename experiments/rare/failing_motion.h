// A trial as a system for multilevel splitting (stats/splitting.h): its random inputs are the state, there
// are moves that preserve their law, and a value says how near the estimator is to a rare event.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "estimator/motion_estimate.h"
#include "experiments/study/study_plan.h"
#include "experiments/trial/trial.h"

namespace rcme {

// The rare event: a failure, or an error beyond the protection level that the answer itself states.
struct RareEvent {
  enum class Kind { kFailure, kMisleadingRotation, kMisleadingDirection };
  Kind kind = Kind::kFailure;
  double risk = 1e-5;  // of the protection levels (estimator/protection_level.h); not used for failures
};
const char* Name(RareEvent::Kind kind);  // "failure", "misleading_rotation", "misleading_direction"

// The greater of rotation and direction error, each divided by its bound: greater than 1 exactly if
// HasFailed. 0 for a refusal, infinite for an answer that is not valid.
double ErrorOverBound(const TrialRecord& record, const FailureBounds& bounds);

// The error of rotation or of direction divided by its protection level: greater than 1 exactly if `rcme
// integrity` counts the answer as misleading. 0 without an answer, or if the error is unknown.
double ErrorOverLevel(const MotionEstimate& estimate, const TrialRecord& record, const RareEvent& event);

// How near the answer is to the event, which has happened above 1.
double ComputeNearness(const MotionEstimate& estimate, const TrialRecord& record, const RareEvent& event,
                       const FailureBounds& bounds);

class SimulatedData;

// The purpose of the streams of splitting, besides those of a trial's streams (StreamPurpose).
inline constexpr std::uint32_t kSplittingPurpose = 100;

// The random inputs of a trial, which determine whether the event happens.
struct MotionInputs {
  std::shared_ptr<const Scene> scene;                 // null: it could not be simulated
  std::vector<double> noise;                          // standard normal, four for each point of the scene
  std::uint64_t outlier_seed = 0, sampling_seed = 0;  // of the streams of outliers and samples
};

// Throws InputError for a study on match files, because scene, noise and outliers of real pairs cannot be
// redrawn.
void RequireDrawnScenes(const Study& study);

class FailingMotion {
 public:
  using State = MotionInputs;

  // One condition of the plan and one of its estimators. Throws InputError that names key and value for match
  // files, for noise that is not normal, and for trials with weights.
  FailingMotion(const StudyPlan& plan, const Condition& condition, size_t estimator,
                const RareEvent& event = {});

  // How many of the first kNumTried draws of a condition of a population could not be simulated. If none
  // could, the condition is not simulated. The law is that of the trials that can be simulated: draws are
  // repeated until one can, and moves to others are rejected.
  static constexpr int kNumTried = 1000;
  int num_not_simulated() const { return num_not_simulated_; }
  const std::string& why_not_simulated() const { return why_not_simulated_; }  // the first of them

  // Draws a state from the law of a trial of the condition, with random numbers that no trial of a run uses.
  // Must not be called if no draw could be simulated.
  State Draw(RandomStream& rng) const;

  // Proposes one of sixteen equally likely moves. Eight are local moves of the noise by preconditioned
  // Crank-Nicolson: sqrt(1 - step^2) z + step z' with fresh normals z' preserves the law of z. If points are
  // independent given the motion (uniform_volume), two renew each point with probability step^2 / 2, and two
  // move the motion; otherwise these four are moves of the noise as well. The other moves are not local: two
  // renew the outliers, one the scene, and one the samples.
  State Propose(const State& state, double step, RandomStream& rng, bool& is_local) const;

  // ComputeNearness of the estimator's answer to the event; minus infinity if the state cannot be simulated.
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
  bool has_free_points_ = false;  // points are independent given the motion
  int num_not_simulated_ = 0;
  std::string why_not_simulated_;
};

}  // namespace rcme
