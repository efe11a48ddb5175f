// The noise of a semi-real twin: such that redrawn templates give the estimator the residuals that the pairs
// give it.
#pragma once

#include "experiments/data/redraw.h"
#include "experiments/truth_free/twin_source.h"

namespace rcme {

// Fitted: the size of the residuals, the ratio of their 95 % point to their median, their correlation up to
// 1 px and beyond. noise_px is 0 where no pair has both an answer and a template.
RedrawSettings FitNoise(const TwinSource& source, const MotionEstimator& estimator, std::uint64_t seed);

}  // namespace rcme
