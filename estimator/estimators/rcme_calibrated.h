// rcme_calibrated: RCME with what its propagated uncertainty is for, the probability that the answer is
// wrong.
//
//   0  prior         motion_prior.h                    of the motion, if the problem has one: in all steps
//                    calibrated/prior_check.h          left out where the matches contradict it
//   1  hypotheses    calibrated/hypothesis_search.h    five-point samples, ranked by a soft score
//   2  modes         calibrated/candidates.h           optima of a mixture likelihood (mixture_fit.h)
//                    calibrated/split_mode.h           two motions in place of a compromise between them
//   3  influence     calibrated/influence.h            without matches that decide by themselves, mostly
//   wrong
//                    calibrated/leverage_branches.h    fits without single ones of large influence that are
//                    left
//   4  twisted pair  calibrated/twisted_pair.h         the other motion of a plane; every mode the other way
//   5  contrast      calibrated/contrast.h             which of two modes explains more where they differ
//   6  odds          calibrated/mode_weights.h         of the other modes, a second motion, no motion
//                    calibrated/noise_choice.h         the answer's tails: five degrees of freedom or fifteen
//   7  P(fail)       calibrated/failure_probability.h  the mass of all modes beyond the failure bounds
//                    calibrated/settle_direction.h     where the parallax is hardly more than the noise
//                    calibrated/model_check.h          whether the matches are as the model has them
//                    calibrated/checked_probability.h  what that makes of the mass and the covariance
//   8  covariance    calibrated/mode_covariance.h      of the modes within the bounds
//   9  posterior     calibrated/motion_posterior.h     all of this as one distribution, where it is asked for
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

// A motion that explains the matches, with the probability that the estimator gives it.
struct WeighedMotion {
  RelativePose cam2_from_cam1;
  double weight = 0.0;
  int num_explained = 0;
  bool is_answer = false;
};

// What the probability of failure of an answer is made of.
struct CheckedVerdict {
  ModelCheck check;
  double by_modes = 1.0;  // the probability by the modes alone, before the check
};

// The inspection of rcme_calibrated: its weights taken apart from its search, its probability from the check.
// Estimate never asks it.
class WeightInspection {
 public:
  virtual ~WeightInspection() = default;
  // What it would make of these motions, had its search found them and nothing else: the optima that are
  // reached from them, and the others that follow from these (steps 3 to 6). A prior of the motion counts
  // unchecked.
  virtual std::vector<WeighedMotion> WeighMotions(const MotionProblem& problem,
                                                  const std::vector<RelativePose>& starts) const = 0;
  // Estimate, and what its probability is made of; that stays as it is where there is no motion.
  virtual MotionEstimate EstimateChecked(const MotionProblem& problem, RandomStream& rng,
                                         CheckedVerdict* verdict) const = 0;
  // The modes that Estimate weighs (steps 1 to 4); none where it refuses before.
  virtual std::vector<ExplainedMode> ListModes(const MotionProblem& problem, RandomStream& rng) const = 0;
  // Estimate, and the distribution that its motion, covariance and probability belong to; nothing where there
  // is no motion. Takes some milliseconds more, up to a tenth of a second where the answer is narrowed.
  virtual MotionEstimate EstimateWithPosterior(const MotionProblem& problem, RandomStream& rng,
                                               std::optional<MotionPosterior>* posterior) const = 0;
};

// The inspection of the estimator's weights, which lives as long as the estimator; null if there is none.
inline const WeightInspection* FindWeightInspection(const MotionEstimator& estimator) {
  return dynamic_cast<const WeightInspection*>(&estimator);
}

// Throws InputError if the options contradict each other.
std::unique_ptr<MotionEstimator> MakeRcmeCalibrated(const CalibratedOptions& options);

std::unique_ptr<EstimatorModel> RcmeCalibratedModel();

}  // namespace rcme
