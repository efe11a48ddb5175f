// Steps 3 and 4 of rcme_calibrated: refits the modes that the samples found and adds the modes that follow
// from them.
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

// Refits every mode without the matches that their influence shows to be outliers (influence.h), and explains
// the matches by it. Then adds three kinds of modes in turn: leverage branches, the other motion of a plane,
// and the opposite translation. Each kind is derived from the modes so far that explain at least half as many
// matches as the best one. Modes that explain five matches or fewer are dropped.
std::vector<ExplainedMode> ExplainMatches(const MotionProblem& problem, const MatchBlocks& matches,
                                          const MixturePrior& prior, const CalibratedOptions& options,
                                          std::vector<Mode> modes);

}  // namespace rcme
