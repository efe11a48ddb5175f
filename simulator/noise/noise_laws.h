// The noise laws that noise_registry lists, one file each.
#pragma once

#include <memory>

#include "simulator/noise_model.h"

namespace rcme {

// Independent normal noise of one standard deviation (assumption a.2). Here sigma 0 is allowed: exact images.
std::unique_ptr<NoiseModel> MakeGaussianNoise(double sigma_px = 0.5);

// Normal, but of different size in different directions, or correlated between the images.
std::unique_ptr<NoiseModel> MakeAnisotropicNoise();
// Normal; the standard deviation depends on the pyramid level at which the point was detected.
std::unique_ptr<NoiseModel> MakeOctaveNoise();

// Heavier tails than normal: in each coordinate separately, or in a share of the matches as a whole.
std::unique_ptr<NoiseModel> MakeStudentNoise();
std::unique_ptr<NoiseModel> MakeLaplaceNoise();
std::unique_ptr<NoiseModel> MakeContaminatedNoise();

// Normal and dependent between matches: correlated between neighbours, or by points that are detected several
// times.
std::unique_ptr<NoiseModel> MakeCorrelatedNoise();
std::unique_ptr<NoiseModel> MakeDuplicatedNoise();
// Normal; a share of the variance is a smooth field of displacements over each image.
std::unique_ptr<NoiseModel> MakeDisplacementFieldNoise();

// Normal, then rounded to the detector's grid.
std::unique_ptr<NoiseModel> MakeQuantisedNoise();

}  // namespace rcme
