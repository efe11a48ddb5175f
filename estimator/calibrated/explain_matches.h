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

// Every mode, fitted anew without the matches that their influence shows to be wrong (influence.h), with what
// it says of the matches. Three kinds are then added in turn, each for the modes so far that explain at least
// half as many matches as the one that explains the most: leverage branches, the other motion of a plane, and
// the other way along t. Only modes that explain more than five matches are kept.
std::vector<ExplainedMode> ExplainMatches(const MotionProblem& problem, const MatchBlocks& matches,
                                          const MixturePrior& prior, const CalibratedOptions& options,
                                          std::vector<Mode> modes);

}  // namespace rcme
