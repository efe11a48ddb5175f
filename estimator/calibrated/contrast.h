// Step 5 of rcme_calibrated: two modes are compared match by match.
//
// On a plane the residuals of the matches that both of two motions explain differ by tens of nats of pure
// noise, so the likelihoods cannot be compared as they are. Matches that only one explains, with the share of
// right matches among them refitted for each of the two, are kept apart from those that both explain, whose
// difference is held against its own standard deviation (Vuong 1989).
#pragma once

#include "estimator/calibrated/explanation.h"

namespace rcme {

struct Contrast {
  double exclusive = 0.0;  // log-likelihood of a minus that of b over matches that only one explains, nats
  double shared = 0.0;     // the same over matches that both explain
  double shared_variance = 0.0;  // of `shared`: its terms' sum of squares about their mean
  // Matches that a explains, and better than b; and the other way round. Of these the ones by kClearly.
  int num_better_a = 0, num_better_b = 0, num_clearly_a = 0, num_clearly_b = 0;
};

inline constexpr double kClearly = 5.0;  // nats; a residual of 3.2 standard deviations against none

// `background`: density of a wrong match's residual, per unit of the assumed sigma, the same for both.
Contrast CompareModes(const Explanation& a, const Explanation& b, double background);

}  // namespace rcme
