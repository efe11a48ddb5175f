// The faults of a camera by self-calibration to convergence: what is named is corrected, and the test of all
// faults holds then.
#pragma once

#include <cstdint>
#include <vector>

#include "estimator/motion_estimator.h"
#include "experiments/core/work/kept_steps.h"
#include "experiments/real/truth_free/calibration_test.h"
#include "experiments/real/truth_free/pair_answers.h"

namespace rcme {

inline constexpr int kMostSteps = 10;

// TestCalibration, and where that names a fault: steps, each at cameras and key points from which the faults
// of before are removed and with motions estimated anew, until every step is less than a tenth of its own
// interval's half. Nothing is named where
//   - that takes more than kMostSteps or leaves what is physically possible;
//   - the residuals that are left go with a fault that is never named (FindOtherFault): a further kind of
//     fault looks like one of those that are;
//   - the faults that are named, corrected alone, leave something: `p_corrected` < 0.05. What is left decides
//     then whether further ones are taken with them, the most certain first.
// Every answer is a step. Pure in the seed and the pairs' names.
CalibrationReport Calibrate(const std::vector<PairAnswers>& answers, const MotionEstimator& estimator,
                            std::uint64_t seed, KeptSteps* steps = nullptr);

// The pairs without the faults that a report names; a readout is removed along the motions that are
// estimated.
PairSet CorrectPairs(const PairSet& set, const CalibrationReport& report, const MotionEstimator& estimator,
                     std::uint64_t seed, KeptSteps* steps = nullptr);

}  // namespace rcme
