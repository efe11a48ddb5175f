#include "estimator/calibrated/calibrated_options.h"

#include <fmt/format.h>

#include <utility>

#include "estimator/robust_covariance/covariance_option.h"
#include "parameters/input_error.h"

namespace rcme {

std::vector<Parameter> Parameters(CalibratedOptions& o) {
  using P = Parameter;
  std::vector<P> all = {
      P::Integer("min_samples", &o.min_samples, {8, 1e6}, "least number of minimal samples"),
      P::Integer("max_samples", &o.max_samples, {8, 1e6},
                 "greatest number; stops when one sample is without wrong matches with probability 0.999; "
                 "gravity adds a quarter in samples of three"),
      P::Integer("num_candidates", &o.num_candidates, {1, 1000}, "hypotheses refined briefly"),
      P::Integer("num_modes", &o.num_modes, {1, 100}, "of these, refined to the optimum"),
      P::Real("max_rotation_error_deg", &o.max_rotation_error_deg, {1e-6, 180.0}, "deg",
              "bound of the stated probability of failure; in a study by default the study's"),
      P::Real("max_direction_error_deg", &o.max_direction_error_deg, {1e-6, 180.0}, "deg",
              "the same for the direction of translation"),
      P::Real("max_failure_probability", &o.max_failure_probability, {0.0, 1.0}, "",
              "a motion with a greater probability of failure is refused (too_uncertain); 1: none"),
      P::Choice("sigma", &o.sigma,
                {{"estimated", SigmaKnowledge::kEstimated}, {"assumed", SigmaKnowledge::kAssumed}},
                "noise level: estimated from the residuals, or the assumed one"),
      P::Choice("covariance", &o.covariance,
                {{"information", CovarianceKind::kInformation},
                 {"sandwich", CovarianceKind::kSandwich},
                 {"robust", CovarianceKind::kRobust}},
                "inverse information, from the residuals (HC2), or one that allows correlated errors and "
                "repeated matches"),
      P::Real("second_motion_odds", &o.second_motion_odds, {0.0, 1.0}, "",
              "odds that a second motion with as many matches over as large an area is the camera's own"),
      P::Choice("leave_out", &o.leave_out,
                {{"none", CalibratedStep::kNone},
                 {"split", CalibratedStep::kSplit},
                 {"second_motion", CalibratedStep::kSecondMotion},
                 {"influence", CalibratedStep::kInfluence},
                 {"branches", CalibratedStep::kBranches},
                 {"twisted_pair", CalibratedStep::kTwistedPair},
                 {"opposite_way", CalibratedStep::kOppositeWay},
                 {"direction_posterior", CalibratedStep::kDirectionPosterior},
                 {"noise_choice", CalibratedStep::kNoiseChoice},
                 {"noise_shape", CalibratedStep::kNoiseShape},
                 {"usual_motions", CalibratedStep::kUsualMotions},
                 {"model_check", CalibratedStep::kModelCheck}},
                "step that is left out, for an ablation"),
      FocalParameter(&o.calibration.focal_sd),
      PrincipalPointParameter(&o.calibration.principal_point_sd_px),
      DistortionParameter(&o.calibration.distortion_sd),
      P::Real("unstated_errors", &o.unstated_errors, {0.0, 1.0}, "",
              "prior probability that the calibration has errors of usual size (1.4 %, 4.7 px, k1 .023), of "
              "the kinds that are not stated; widens the covariance where the matches show them; 0: never"),
  };
  for (P& parameter : Parameters(o.robust)) all.push_back(std::move(parameter));
  return all;
}

void Validate(const CalibratedOptions& options) {
  if (options.min_samples > options.max_samples) {
    throw InputError(fmt::format("min_samples is {}, more than max_samples, {}", options.min_samples,
                                 options.max_samples));
  }
  if (options.covariance == CovarianceKind::kRobust) return;
  RobustCovarianceOptions given = options.robust, unset;
  RequireUnset(Parameters(given), Parameters(unset));
}

}  // namespace rcme
