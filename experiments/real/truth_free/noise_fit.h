// Fits the noise of twins, so that the estimator's residuals on them have the size, tails and correlation
// that they have on the pairs.
#pragma once

#include "experiments/real/truth_free/twin_fit.h"

namespace rcme {

// Noise of the semi-real twin. It is fitted to the geometric mean of the estimated noise, the ratio of the
// residuals' 95 % point to their median, and their correlation up to 1 px and beyond. Right matches stay
// within the distance of the farthest inliers of the pairs. noise_px is 0 if no template has an estimate. The
// fit uses random streams of its own. Each noise that is tried is a step.
RedrawSettings FitNoise(const TwinSource& source, const MotionEstimator& estimator, std::uint64_t seed,
                        KeptSteps* steps = nullptr);

// Noise of the simulated twin, after its layout is fitted. Size and tails are fitted again, since its points
// and wrong matches differ and so do the estimator's residuals.
RedrawSettings FitSimulatedNoise(const TwinSource& source, const TwinFit& fit, double clustered_share,
                                 const MotionEstimator& estimator, double assumed_sigma_px,
                                 std::uint64_t seed, KeptSteps* steps = nullptr);

}  // namespace rcme
