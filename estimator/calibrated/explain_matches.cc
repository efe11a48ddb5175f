#include "estimator/calibrated/explain_matches.h"

#include <algorithm>

#include "estimator/calibrated/candidates.h"
#include "estimator/calibrated/hypothesis_search.h"
#include "estimator/calibrated/influence.h"
#include "estimator/calibrated/leverage_branches.h"
#include "estimator/calibrated/twisted_pair.h"

namespace rcme {
namespace {

// With fewer explained matches a large influence is nothing unusual.
constexpr int kLeastExplained = 30;
constexpr int kMostRounds = 3, kStepsWithout = 8;
constexpr int kStepsToCompare = 3, kStepsToConverge = 20;
// Least share of a mode's inliers near one plane for which the other motion of the plane is tried.
constexpr double kPlanarShare = 0.6;

// Stops using these matches. Returns whether the mode used any of them.
bool LeaveOut(const std::vector<size_t>& wrong, Mode* mode) {
  bool has_changed = false;
  for (const size_t i : wrong) {
    const auto bit = static_cast<std::uint8_t>(1u << (i % kBlockSize));
    if (!(mode->used[i / kBlockSize] & bit)) continue;
    mode->used[i / kBlockSize] &= static_cast<std::uint8_t>(~bit);
    has_changed = true;
  }
  return has_changed;
}

class ModeList {
 public:
  ModeList(const MotionProblem& problem, const MatchBlocks& matches, const MixturePrior& prior,
           CalibratedStep leave_out)
      : problem_(problem), matches_(matches), prior_(prior), leave_out_(leave_out) {}

  const std::vector<ExplainedMode>& modes() const { return modes_; }
  bool Knows(const Mode& mode, double standard_deviations = 5.0) const {
    return std::ranges::any_of(modes_, [&](const ExplainedMode& known) {
      return IsSameMode(known.mode, mode, standard_deviations);
    });
  }
  // The modes that explain at least half as many matches as the one that explains the most.
  std::vector<size_t> Notable() const {
    std::vector<size_t> notable;
    for (size_t i = 0; i < modes_.size(); ++i) {
      if (2 * modes_[i].explanation.num_explained >= most_explained_) notable.push_back(i);
    }
    return notable;
  }
  // Refits the mode without the matches that their influence shows to be outliers, and again while there are
  // any, at most three times. Returns whether the mode changed.
  bool LeaveOutInfluential(Mode* mode, Explanation* explanation) const {
    int round = 0;
    for (; round < kMostRounds && explanation->num_explained >= kLeastExplained; ++round) {
      Mode without = *mode;
      if (!LeaveOut(ListWrongByInfluence(*mode, *explanation), &without)) break;
      if (!FitMode(matches_, prior_, kStepsWithout, &without)) break;
      Explanation fewer = Explain(matches_, without);
      if (2 * fewer.num_explained < explanation->num_explained) break;
      *mode = std::move(without);
      *explanation = std::move(fewer);
    }
    return round > 0;
  }
  void Add(Mode mode) {
    Explanation explanation = Explain(matches_, mode);
    const bool is_pruned =
        leave_out_ != CalibratedStep::kInfluence && 2 * explanation.num_explained >= most_explained_;
    if (is_pruned && LeaveOutInfluential(&mode, &explanation) && Knows(mode, 1.0)) return;
    most_explained_ = std::max(most_explained_, explanation.num_explained);
    if (explanation.num_explained <= 5) return;  // any motion through five matches explains them
    modes_.push_back({std::move(mode), std::move(explanation)});
  }
  void AddBranches(size_t i) {
    for (Mode& branch : LeverageBranches(matches_, prior_, modes_[i].mode, modes_[i].explanation)) {
      if (!Knows(branch, 1.0)) Add(std::move(branch));
    }
  }
  void AddTwistedPair(size_t i) {
    const RelativePose pose = modes_[i].mode.pose;
    const std::optional<VisiblePlane> plane =
        FindPlane(problem_, pose, modes_[i].explanation.probability, kPlanarShare);
    const std::optional<RelativePose> other = plane ? OtherMotionOfPlane(pose, *plane) : std::nullopt;
    if (!other) return;
    Mode mode = modes_[i].mode;
    mode.pose = *other;
    mode.origin = ModeOrigin::kTwistedPair;
    FitMode(matches_, prior_, kStepsToCompare, &mode);
    if (Knows(mode)) return;
    if (FitMode(matches_, prior_, kStepsToConverge, &mode) && !Knows(mode)) Add(std::move(mode));
  }
  // Takes a single step: an optimum for -t is not sought, because only c(z) distinguishes the two motions.
  void AddOppositeWay(size_t i) {
    // The sign of t is clear if, net of those behind, more than a quarter of the inliers lie clearly in
    // front.
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
  CalibratedStep leave_out_;
  std::vector<ExplainedMode> modes_;
  int most_explained_ = 0;
};

}  // namespace

std::vector<ExplainedMode> ExplainMatches(const MotionProblem& problem, const MatchBlocks& matches,
                                          const MixturePrior& prior, const CalibratedOptions& options,
                                          std::vector<Mode> modes) {
  using Step = CalibratedStep;
  ModeList list(problem, matches, prior, options.leave_out);
  for (Mode& mode : modes) list.Add(std::move(mode));
  const auto for_notable = [&](Step step, auto add) {
    if (options.leave_out == step) return;
    for (const size_t i : list.Notable()) add(i);
  };
  for_notable(Step::kBranches, [&](size_t i) { list.AddBranches(i); });
  for_notable(Step::kTwistedPair, [&](size_t i) { list.AddTwistedPair(i); });
  for_notable(Step::kOppositeWay, [&](size_t i) { list.AddOppositeWay(i); });
  return list.modes();
}

}  // namespace rcme
