#include "estimator/calibrated/explain_matches.h"

#include <algorithm>

#include "estimator/calibrated/candidates.h"
#include "estimator/calibrated/hypothesis_search.h"
#include "estimator/calibrated/leverage_branches.h"
#include "estimator/calibrated/twisted_pair.h"

namespace rcme {
namespace {

constexpr int kFewSteps = 3, kMostSteps = 20;
// Of a mode's right matches near one plane: its other motion is looked at.
constexpr double kPlanarShare = 0.6;

class ModeList {
 public:
  ModeList(const MotionProblem& problem, const MatchBlocks& matches, const MixturePrior& prior)
      : problem_(problem), matches_(matches), prior_(prior) {}

  const std::vector<ExplainedMode>& modes() const { return modes_; }
  bool Knows(const Mode& mode, double standard_deviations = 5.0) const {
    return std::ranges::any_of(modes_, [&](const ExplainedMode& known) {
      return IsSameMode(known.mode, mode, standard_deviations);
    });
  }
  // The modes that explain at least half as many matches as the one that explains the most.
  std::vector<size_t> Notable() const {
    int most = 0;
    for (const ExplainedMode& mode : modes_) most = std::max(most, mode.explanation.num_explained);
    std::vector<size_t> notable;
    for (size_t i = 0; i < modes_.size(); ++i) {
      if (2 * modes_[i].explanation.num_explained >= most) notable.push_back(i);
    }
    return notable;
  }
  void Add(Mode mode) {
    Explanation explanation = Explain(matches_, mode);
    if (explanation.num_explained <= 5) return;  // as many follow any motion through them
    modes_.push_back({std::move(mode), std::move(explanation)});
  }
  void AddBranches(size_t i) {
    for (Mode& branch : LeverageBranches(matches_, prior_, modes_[i].mode, modes_[i].explanation)) {
      if (!Knows(branch, 1.0)) Add(std::move(branch));
    }
  }
  void AddTwistedPair(size_t i) {
    const RelativePose pose = modes_[i].mode.pose;
    const std::optional<Eigen::Vector3d> plane =
        FindPlane(problem_, pose, modes_[i].explanation.probability, kPlanarShare);
    const std::optional<RelativePose> other = plane ? OtherMotionOfPlane(pose, *plane) : std::nullopt;
    if (!other) return;
    Mode mode = modes_[i].mode;
    mode.pose = *other;
    mode.origin = ModeOrigin::kTwistedPair;
    FitMode(matches_, prior_, kFewSteps, &mode);
    if (Knows(mode)) return;
    if (FitMode(matches_, prior_, kMostSteps, &mode) && !Knows(mode)) Add(std::move(mode));
  }
  // The likelihood's optimum for the other sign of t is not sought: only c(z) tells the two apart.
  void AddOppositeWay(size_t i) {
    // Of the right matches more than a quarter by more than their noise: no.
    const double ahead = SumCheirality(matches_, matches_.num_blocks(), modes_[i].mode.pose, kSoftScale);
    if (ahead > 10.0 + 0.25 * modes_[i].explanation.num_explained) return;
    Mode mode = modes_[i].mode;
    mode.pose.t = -mode.pose.t;
    mode.origin = ModeOrigin::kOppositeWay;
    FitMode(matches_, prior_, 1, &mode);
    if (!Knows(mode)) Add(std::move(mode));
  }

 private:
  const MotionProblem& problem_;
  const MatchBlocks& matches_;
  const MixturePrior& prior_;
  std::vector<ExplainedMode> modes_;
};

}  // namespace

std::vector<ExplainedMode> ExplainMatches(const MotionProblem& problem, const MatchBlocks& matches,
                                          const MixturePrior& prior, std::vector<Mode> modes) {
  ModeList list(problem, matches, prior);
  for (Mode& mode : modes) list.Add(std::move(mode));
  for (const size_t i : list.Notable()) list.AddBranches(i);
  for (const size_t i : list.Notable()) list.AddTwistedPair(i);
  for (const size_t i : list.Notable()) list.AddOppositeWay(i);
  return list.modes();
}

}  // namespace rcme
