// Between steps 6 and 7 of rcme_calibrated: the noise law of the answer, by its own residuals.
//
// The search and the odds need one law that resists tails of any kind: Student's with five degrees of
// freedom. Where the noise is Gaussian its efficiency is .919, that of fifteen degrees .984, a standard
// deviation 3 % smaller; with a hundred matches the residuals say which. Three degrees are no better where
// the tails are heavy: chosen by likelihood too, they left Student's and Laplace's noise as it was and made
// errors in contaminated noise and in that of octaves 2.4 % greater (n = 1,200 each).
#pragma once

#include "estimator/calibrated/explain_matches.h"

namespace rcme {

// Fits the answer anew with fifteen degrees of freedom and keeps this law where the matches that it uses are
// more likely under it by at least two nats.
void ChooseNoiseLaw(const MatchBlocks& matches, const MixturePrior& prior, ExplainedMode* answer);

}  // namespace rcme
