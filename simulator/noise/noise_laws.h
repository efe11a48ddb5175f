// The noise laws that noise_registry lists, one file each.
#pragma once

#include <memory>

#include "simulator/noise_model.h"

namespace rcme {

// Independent normal noise of one standard deviation (assumption a.2); sigma 0 is allowed here: exact images.
std::unique_ptr<NoiseModel> MakeGaussianNoise(double sigma_px = 0.5);

// Normal, but not of the same size in all directions, or not independent from image to image.
std::unique_ptr<NoiseModel> MakeAnisotropicNoise();
// Normal with a standard deviation that depends on the pyramid level where the point was detected.
std::unique_ptr<NoiseModel> MakeOctaveNoise();

// Longer tails than normal: in every coordinate of its own, or in a share of the matches as a whole.
std::unique_ptr<NoiseModel> MakeStudentNoise();
std::unique_ptr<NoiseModel> MakeLaplaceNoise();
std::unique_ptr<NoiseModel> MakeContaminatedNoise();

// Normal, and not independent from match to match: correlated between neighbours, or with points that are
// found several times.
std::unique_ptr<NoiseModel> MakeCorrelatedNoise();
std::unique_ptr<NoiseModel> MakeDuplicatedNoise();
// Normal, of which a share is a smooth field of displacements over each image.
std::unique_ptr<NoiseModel> MakeDisplacementFieldNoise();

// Normal, then rounded to the detector's grid.
std::unique_ptr<NoiseModel> MakeQuantisedNoise();

}  // namespace rcme
