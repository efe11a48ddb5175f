// Simulates several images of one scene, and the pairs among them.
#pragma once

#include <vector>

#include "experiments/data/simulated_data.h"

namespace rcme {

inline constexpr int kMostSequenceImages = 50;
// Two images that both see fewer points make no pair.
inline constexpr size_t kLeastSequencePoints = 20;

struct SequencePair {
  int image1 = 0, image2 = 0;  // from 0
  TrialData data;
};

// Each image is moved relative to the one before by the motion of the trial's scene: an orbit continues
// around its point, a car along its arc. All images have the first camera and see the points of the scene
// that lie within them; points do not hide each other. The pairs are each image with its successor and with
// the first image, which gives a loop of each length.
//
// A key point is detected once per image: it has the same error in all pairs of the image, so the errors of
// these pairs depend on each other. Coordinates are rounded to 1e-6 px, so that coordinates of the same key
// point are equal. Wrong matches are drawn for each pair.
//
// Throws InputError for noise that is not gaussian and for a rolling shutter, and NotSimulated as
// SimulatedData does.
std::vector<SequencePair> SimulateSequence(const SimulatedData& data, const StreamName& trial_name,
                                           int num_images);

}  // namespace rcme
