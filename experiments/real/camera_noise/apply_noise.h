// Applies a camera's noise file to a pair: removes the errors that were found and assumes the noise that was
// measured.
#pragma once

#include <memory>
#include <string>

#include "estimator/motion_estimator.h"
#include "experiments/data/camera_noise.h"
#include "experiments/real/truth_free/pair_set.h"

namespace rcme {

// ReadCameraNoise for the functions below. Also throws InputError if the file removes a fault larger than
// GreatestFault (truth_free/camera_faults.h).
CameraNoise ReadNoiseToApply(const std::string& path);

// Whether image sizes are equal and the intrinsics agree to a relative 1e-4.
bool IsSameCamera(const Camera& camera, const Camera& other);

// Sets the assumed sigma and noise_scale from the file, and corrects cameras and key points for the faults
// that it removes, except the readout, which depends on the motion (CorrectReadout). Throws InputError that
// begins with `origin` if the file removes something and the pair is of another camera (IsSameCamera).
MotionProblem ApplyNoise(MotionProblem problem, const CameraNoise& noise, const std::string& origin);

bool RemovesReadout(const CameraNoise& noise);
// Corrects the key points to those of a global shutter, for an estimated motion. seconds_between: time
// between the images; if NaN, that of the file.
MotionProblem CorrectReadout(MotionProblem problem, const RelativePose& cam2_from_cam1,
                             const CameraNoise& noise, double seconds_between);

// Replaces the covariance of the estimate by
//
//   C = d (s_0 C_0 + C_shared) + G U G'.
//
// The design effect d of blocks and C_shared are those of robust_covariance.h, but with the file's variances
// and reach instead of those from the pair's own residuals. If the file has no field, those of its unseen
// field are used. C_0 is the estimator's own covariance, or with `is_robust` that of the residuals. U is the
// uncertainty of the camera's faults (fault_posterior.h), whether removed or not. G = -A^-1 sum J_i' D_i is
// the derivative of the motion by the faults, with A = sum J_i' J_i and D_i the derivative of the residual by
// the faults (truth_free/calibration_score.h). G U G' is omitted for a pair of another camera than the
// file's. Errors of the calibration that nobody stated are no noise of the matches: they add what they added
// before.
//
// With `is_robust` the first term replaces the estimator's covariance only if it is wider in tr(A C), since
// neighbours in this pair can share more than the file states. Nothing changes if the file has neither shared
// variance nor uncertain faults, or the estimate has no motion.
void WidenCovariance(const MotionProblem& problem, const CameraNoise& noise, bool is_robust,
                     MotionEstimate* estimate);

// Wraps an estimator with WidenCovariance, for pairs to which the noise has been applied.
std::unique_ptr<MotionEstimator> WithSharedNoise(std::unique_ptr<MotionEstimator> estimator,
                                                 const CameraNoise& noise, bool is_robust);

// ApplyNoise to every pair of a set, and CorrectReadout for the motions that `estimator` finds.
PairSet ApplyNoiseTo(PairSet set, const CameraNoise& noise, const MotionEstimator& estimator,
                     std::uint64_t seed);

}  // namespace rcme
