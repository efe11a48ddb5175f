// The noise of twins: such that they give the estimator residuals of the size, the tails and the correlation
// that the pairs give it.
#pragma once

#include "experiments/real/truth_free/twin_fit.h"

namespace rcme {

// Of the semi-real twin. Fitted to the answers: the geometric mean of the estimated noise, the ratio of the
// residuals' 95 % point to their median, their correlation up to 1 px and beyond. Right matches stay as near
// as those of the pairs are. noise_px is 0 where no template has an answer. Its streams are its own. Each
// noise that is tried is a step.
RedrawSettings FitNoise(const TwinSource& source, const MotionEstimator& estimator, std::uint64_t seed,
                        KeptSteps* steps = nullptr);

// Of the simulated twin, whose layout is fitted: size and tails anew, since other points and wrong matches
// leave the estimator other residuals.
RedrawSettings FitSimulatedNoise(const TwinSource& source, const TwinFit& fit, double clustered_share,
                                 const MotionEstimator& estimator, double assumed_sigma_px,
                                 std::uint64_t seed, KeptSteps* steps = nullptr);

}  // namespace rcme
