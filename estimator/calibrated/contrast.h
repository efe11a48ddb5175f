// Step 5 of rcme_calibrated: compares two modes match by match.
//
// The plain likelihoods of two motions cannot be compared: on a plane, the residuals of matches that both
// explain differ by tens of nats of pure noise. So the matches are divided. For those that only one motion
// explains, the share of inliers is refitted for each of the two. For those that both explain, the difference
// is compared with its own standard deviation (Vuong 1989).
#pragma once

#include "estimator/calibrated/explanation.h"

namespace rcme {

struct Contrast {
  double exclusive = 0.0;  // log-likelihood of a minus that of b over matches that only one explains, nats
  double shared = 0.0;     // the same over matches that both explain
  double shared_variance = 0.0;  // of `shared`: sum of squares of its terms about their mean
  // How many matches a explains and explains better than b, and conversely; "clearly" means by kClearly.
  int num_better_a = 0, num_better_b = 0, num_clearly_a = 0, num_clearly_b = 0;
};

inline constexpr double kClearly = 5.0;  // nats; a residual of 3.2 standard deviations against one of zero

// `background`: density of an outlier's residual, per unit of the assumed sigma, the same for both modes.
Contrast CompareModes(const Explanation& a, const Explanation& b, double background);

}  // namespace rcme
