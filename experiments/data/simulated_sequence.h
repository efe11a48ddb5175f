// Several images of one simulated scene, and what each two of them give.
#pragma once

#include <vector>

#include "experiments/data/simulated_data.h"

namespace rcme {

inline constexpr int kMostSequenceImages = 50;
// Fewer points that both images see make no pair.
inline constexpr size_t kLeastSequencePoints = 20;

struct SequencePair {
  int image1 = 0, image2 = 0;  // from 0
  TrialData data;
};

// Each image is moved from the one before as image 2 of the trial's scene is from image 1: an orbit goes on
// around its point, a car along its arc. All have the first camera, and see those points of that scene that
// lie in them; none hides another. A pair is an image with the next, and with the first, so that there is a
// loop of each length.
//
// A key point is found once in an image: it has one error in all pairs of that image, whose errors therefore
// depend on each other. Coordinates are rounded to 1e-6 px, so that equal key points have equal ones. Wrong
// matches are drawn for each pair.
//
// Throws InputError for noise that is not gaussian and for a rolling shutter; NotSimulated as SimulatedData.
std::vector<SequencePair> SimulateSequence(const SimulatedData& data, const StreamName& trial_name,
                                           int num_images);

}  // namespace rcme
