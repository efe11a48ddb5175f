// Steps 3 and 4 of rcme_calibrated: the modes that the samples found, and those that follow from them.
#pragma once

#include <vector>

#include "estimator/calibrated/calibrated_options.h"
#include "estimator/calibrated/explanation.h"
#include "estimator/calibrated/mixture_fit.h"
#include "estimator/motion_problem.h"

namespace rcme {

struct ExplainedMode {
  Mode mode;
  Explanation explanation;
};

// Every mode with what it says of the matches, then, of those that explain at least half of what the best
// does, the leverage branches, the other motion of its plane and each of these the other way; those only that
// explain more than five matches.
std::vector<ExplainedMode> ExplainMatches(const MotionProblem& problem, const MatchBlocks& matches,
                                          const MixturePrior& prior, std::vector<Mode> modes);

}  // namespace rcme
