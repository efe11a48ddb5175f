// Steps 5 and 6 of rcme_calibrated: chooses the answer among the modes, and computes how likely each is to be
// the camera's motion.
#pragma once

#include <array>
#include <vector>

#include "estimator/calibrated/calibrated_options.h"
#include "estimator/calibrated/explain_matches.h"
#include "estimator/calibrated/failure_probability.h"
#include "estimator/calibrated/mode_weights.h"

namespace rcme {

struct ModeWeights {
  size_t answer = 0;
  std::vector<double> of_modes;        // probability of each; with of_no_motion they sum to one
  double of_no_motion = 0.0;           // that all matches are outliers
  std::vector<bool> is_rival;          // beyond the bounds around the answer
  std::vector<bool> is_second_motion;  // explains many matches that the answer does not; its odds are a prior
};

// The answer is the mode against which no other one has positive log-odds, by ModeLogOdds. Two motions of
// their own (IsSecondMotion) are compared by what either explains (SecondMotionLogOdds). The search starts at
// modes[0].
//
// Modes within `bounds` of the answer are the same motion found more than once: together they have the weight
// of one. Rivals resemble each other, too, so that their odds add up to less than their sum: to (sum
// odds^2.5)^(1/2.5). The exponent comes from a regression of failure on all rivals of an answer. A prior of
// the motion adds its evidence for each mode (ComputePriorEvidence) to the mode's log-odds. Its evidence for
// the answer also lowers the odds of no motion, because without a motion its measurements would be unrelated.
ModeWeights WeighModes(const std::vector<ExplainedMode>& modes, const MotionBounds& bounds,
                       const MixturePrior& prior, const CalibratedOptions& options);

// The weights after the answer has moved: another mode within one standard deviation of it is the same, and
// its weight is the answer's.
ModeWeights WithoutCopies(const std::vector<ExplainedMode>& modes, ModeWeights weights);

// For each mode, whether it is beyond the bounds around the answer. Call it again after the answer has moved.
std::vector<bool> FindRivals(const std::vector<ExplainedMode>& modes, size_t answer,
                             const MotionBounds& bounds);

// Two modes, and the evidence for the first (ComputeModeTerms).
struct ModePair {
  size_t a = 0, b = 0;
  std::array<double, kNumModeTerms> terms{};
  bool is_second_motion = false;  // two motions, whose odds depend on the following terms instead
  std::array<double, kNumSecondMotionTerms> second_motion_terms{};
};

// Log-odds that mode a is the camera's motion rather than b, by their matches and the priors
// (mode_weights.h).
double ComputeLogOdds(const ExplainedMode& a, const ExplainedMode& b, const MixturePrior& prior,
                      CalibratedStep leave_out);

// All pairs of modes with a < b.
std::vector<ModePair> ListModePairs(const std::vector<ExplainedMode>& modes);

}  // namespace rcme
