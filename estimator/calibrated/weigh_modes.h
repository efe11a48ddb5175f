// Steps 5 and 6 of rcme_calibrated: which mode is the answer, and how likely each is to be the camera's
// motion.
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
  double of_no_motion = 0.0;           // that the matches are wrong altogether
  std::vector<bool> is_rival;          // beyond the bounds around the answer
  std::vector<bool> is_second_motion;  // explains many matches that the answer does not; its odds are a prior
};

// The answer is the mode that no other one is more likely than, by ModeLogOdds or, of two motions of their
// own (IsSecondMotion), by the number of matches that either explains better; begun at the greatest
// likelihood. Modes within `bounds` of it are the same motion found more than once: together they weigh as
// much as it. The others are alike among themselves, too, so that their odds add up to less than their sum:
// to (sum odds^2.5)^(1/2.5), the exponent from a regression of failure on all rivals of an answer. A prior of
// the motion adds what it says of each mode (ComputePriorEvidence) to its log-odds, and takes what it says of
// the answer from those of no motion, of which its measurements would know nothing.
ModeWeights WeighModes(const std::vector<ExplainedMode>& modes, const MotionBounds& bounds,
                       const MixturePrior& prior, const CalibratedOptions& options);

// For each mode whether it is beyond the bounds around the answer: anew where that has moved since the modes
// were weighed.
std::vector<bool> FindRivals(const std::vector<ExplainedMode>& modes, size_t answer,
                             const MotionBounds& bounds);

// Two modes, and what speaks for the first (ComputeModeTerms).
struct ModePair {
  size_t a = 0, b = 0;
  std::array<double, kNumModeTerms> terms{};
  bool is_second_motion = false;  // motions of their own, of which the terms do not decide
};

// Every two of the modes once, a < b.
std::vector<ModePair> ListModePairs(const std::vector<ExplainedMode>& modes);

}  // namespace rcme
