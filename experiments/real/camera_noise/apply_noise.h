// A pair as a camera's noise file says it is: without the errors that were found, with the noise that was
// measured.
#pragma once

#include <memory>
#include <string>

#include "estimator/motion_estimator.h"
#include "experiments/data/camera_noise.h"
#include "experiments/real/truth_free/pair_set.h"

namespace rcme {

// ReadCameraNoise for what follows. Throws InputError too where the file removes more of a fault than a
// camera may have (truth_free/camera_faults.h: GreatestFault).
CameraNoise ReadNoiseToApply(const std::string& path);

// Whether images are of one size and intrinsics alike to 1e-4.
bool IsSameCamera(const Camera& camera, const Camera& other);

// The assumed sigma and noise_scale are those of the file; cameras and key points are without the faults that
// it removes, but for the readout, which goes along a motion (CorrectReadout). Throws InputError that begins
// with `origin` where the file removes something and the pair is of another camera: intrinsics that differ by
// more than 1e-4, or another image size.
MotionProblem ApplyNoise(MotionProblem problem, const CameraNoise& noise, const std::string& origin);

bool RemovesReadout(const CameraNoise& noise);
// The key points of a global shutter, along an estimated motion; seconds_between: of the images, NaN where
// it is not known, and then that of the file.
MotionProblem CorrectReadout(MotionProblem problem, const RelativePose& cam2_from_cam1,
                             const CameraNoise& noise, double seconds_between);

//   C = d (s_0 C_0 + C_shared) + G U G'
//
// d the design effect of blocks and C_shared as in robust_covariance.h, with the file's variances and reach
// in place of those that the pair's own residuals tell, and those of the unseen field where none was found;
// C_0 the estimator's own covariance, or with `is_robust` that of the residuals; U the uncertainty of the
// camera's faults (fault_posterior.h), removed or not, and G = -A^-1 sum J_i' D_i how they move the motion,
// D_i the residual's derivative along them. A pair of another camera than the file's is without G U G'
// (truth_free/calibration_score.h), A = sum J_i' J_i. A robust covariance stays
// where that of the pair's own residuals is wider in tr(A C): what neighbours of this pair share can be more
// than the file knows. As it is where nothing is shared or removed, or there is no motion.
void WidenCovariance(const MotionProblem& problem, const CameraNoise& noise, bool is_robust,
                     MotionEstimate* estimate);

// The estimator with covariances that are widened, for pairs to which the noise has been applied.
std::unique_ptr<MotionEstimator> WithSharedNoise(std::unique_ptr<MotionEstimator> estimator,
                                                 const CameraNoise& noise, bool is_robust);

// ApplyNoise to every pair of a set; a readout is removed along the motions that `estimator` finds.
PairSet ApplyNoiseTo(PairSet set, const CameraNoise& noise, const MotionEstimator& estimator,
                     std::uint64_t seed);

}  // namespace rcme
