// Estimates camera faults by self-calibration to convergence. A fault is named only if the pairs, corrected
// for the named faults, pass the test of all faults.
#pragma once

#include <cstdint>
#include <vector>

#include "estimator/motion_estimator.h"
#include "experiments/core/work/kept_steps.h"
#include "experiments/real/truth_free/calibration_test.h"
#include "experiments/real/truth_free/pair_set.h"

namespace rcme {

inline constexpr int kMostSteps = 10;

// Runs TestCalibration. If that names a fault, it iterates: each iteration removes the faults estimated so
// far from cameras and key points and estimates the motions again, until every change is at most a tenth of
// the half-width of its interval. Then it corrects the named faults only; while the test of all faults still
// rejects (p < 0.05), it adds the most significant other fault. No fault is named if
//   - the iteration takes more than kMostSteps or leaves the physically possible range;
//   - the test still rejects and no other fault is significant; or
//   - the remaining residuals show a fault that is never named (FindOtherFault), which may have looked like a
//     named one.
// Every estimate is a step. The random stream of a pair depends only on the seed and the pair's name.
CalibrationReport Calibrate(const std::vector<PairAnswers>& answers, const MotionEstimator& estimator,
                            std::uint64_t seed, KeptSteps* steps = nullptr);

// Corrects the pairs for the faults that a report names. The readout is corrected for the estimated motions.
PairSet CorrectPairs(const PairSet& set, const CalibrationReport& report, const MotionEstimator& estimator,
                     std::uint64_t seed, KeptSteps* steps = nullptr);

}  // namespace rcme
