// rcme_calibrated: an RCME that uses its propagated uncertainty to state the probability that its answer is
// wrong. The steps:
//
//   0  prior         motion_prior.h                    of the motion, if the problem has one; for all steps
//                    calibrated/prior_check.h          not used if the matches contradict it
//   1  hypotheses    calibrated/hypothesis_search.h    five-point samples, ranked by a soft score
//                    calibrated/upright_search.h       three-point samples too, if gravity is measured
//   2  modes         calibrated/candidates.h           optima of a mixture likelihood (mixture_fit.h)
//                    calibrated/split_mode.h           two motions in place of a compromise between them
//                    calibrated/second_motion.h        adds the motion of matches that no mode explains
//   3  influence     calibrated/influence.h            discounts matches that determine a motion alone
//                    calibrated/leverage_branches.h    adds fits without single matches of large influence
//   4  twisted pair  calibrated/twisted_pair.h         adds the other motion of a plane, opposite directions
//   5  contrast      calibrated/contrast.h             compares two modes on matches where they differ
//   6  odds          calibrated/mode_weights.h         of the modes, a second motion, and no motion
//                    calibrated/noise_choice.h         tails of the answer's noise: Student's t, 5 or 15 dof
//   7  P(fail)       calibrated/failure_probability.h  the mass of all modes beyond the failure bounds
//                    calibrated/settle_direction.h     the direction if parallax hardly exceeds the noise
//                    calibrated/model_check.h          how far the matches fit the assumptions
//                    calibrated/checked_probability.h  corrects P(fail) and covariance by this check
//   8  covariance    calibrated/mode_covariance.h      of the modes within the bounds
//                    calibrated/judge_modes.h          steps 7 and 8 together
//   9  posterior     calibrated/motion_posterior.h     all of this as one distribution, on request
//
// If the residuals show that the noise is anisotropic (calibrated/noise_shape.h), all steps run once more in
// coordinates in which it is not (calibrated/whitened_problem.h).
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "estimator/calibrated/calibrated_options.h"
#include "estimator/calibrated/explain_matches.h"
#include "estimator/calibrated/model_check.h"
#include "estimator/calibrated/motion_posterior.h"
#include "estimator/estimator_model.h"

namespace rcme {

// A motion that explains the matches, with its probability.
struct WeighedMotion {
  RelativePose cam2_from_cam1;
  double weight = 0.0;
  int num_explained = 0;
  bool is_answer = false;
};

// The parts of the failure probability of an answer.
struct CheckedVerdict {
  ModelCheck check;
  double by_modes = 1.0;  // failure probability from the modes alone, before the check
};

// Access to the stages of rcme_calibrated: weights without the search, probability before the check. Estimate
// does not use it.
class WeightInspection {
 public:
  virtual ~WeightInspection() = default;
  // The weighed motions if the search had found exactly `starts`: the optima reached from them, and those
  // that steps 3 to 6 add. The prior of the motion is used unchecked.
  virtual std::vector<WeighedMotion> WeighMotions(const MotionProblem& problem,
                                                  const std::vector<RelativePose>& starts) const = 0;
  // Estimate, and the parts of its failure probability; *verdict stays unchanged if there is no motion.
  virtual MotionEstimate EstimateChecked(const MotionProblem& problem, RandomStream& rng,
                                         CheckedVerdict* verdict) const = 0;
  // The modes that Estimate weighs in its first pass (steps 1 to 4); empty if it refuses earlier.
  virtual std::vector<ExplainedMode> ListModes(const MotionProblem& problem, RandomStream& rng) const = 0;
  // Estimate, and the distribution from which its motion, covariance and probability are computed; nullopt if
  // there is no motion. Takes a few milliseconds more than Estimate, up to 0.1 s if the answer is narrowed
  // (motion_posterior.h).
  virtual MotionEstimate EstimateWithPosterior(const MotionProblem& problem, RandomStream& rng,
                                               std::optional<MotionPosterior>* posterior) const = 0;
};

// The WeightInspection of an estimator, valid as long as the estimator lives; null if it has none.
inline const WeightInspection* FindWeightInspection(const MotionEstimator& estimator) {
  return dynamic_cast<const WeightInspection*>(&estimator);
}

// Throws InputError if the options contradict each other.
std::unique_ptr<MotionEstimator> MakeRcmeCalibrated(const CalibratedOptions& options);

std::unique_ptr<EstimatorModel> RcmeCalibratedModel();

}  // namespace rcme
