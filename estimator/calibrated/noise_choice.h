// Between steps 6 and 7 of rcme_calibrated: chooses the noise law of the answer by its own residuals.
//
// The search and the odds need one law that resists tails of any kind: Student's with five degrees of
// freedom. For Gaussian noise its efficiency is .919, that of fifteen degrees .984, which is a standard
// deviation smaller by 3 %. A hundred matches suffice to decide between them. Three degrees are no better for
// heavy tails: chosen by likelihood as well, they did not change the errors in Student's and Laplace's noise,
// and increased those in contaminated noise and in noise by octave by 2.4 % (n = 1,200 each).
#pragma once

#include "estimator/calibrated/explain_matches.h"

namespace rcme {

// Refits the answer with fifteen degrees of freedom. Keeps this law if the matches that the answer uses are
// more likely under it by at least two nats.
void ChooseNoiseLaw(const MatchBlocks& matches, const MixturePrior& prior, ExplainedMode* answer);

}  // namespace rcme
