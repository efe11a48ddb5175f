// Is the given truth of a pair wrong? From the matches alone, and with a known rate of false alarms.
//
// The matches are divided into two halves that share no neighbourhood of image 1: the squares of a 12 x 12
// chessboard. An estimator finds a motion in one half, and the other half, which it has not seen, decides
// between this motion and the truth, moved within its reach to where it explains that half best
// (truth_reach.h). One match of each key point counts. Both motions explain a match with the same mixture of
// right and wrong ones (calibrated/mixture_parameters.h), that of the motion with the greater likelihood, if
// it is right with a probability of more than one half. Then the roles of the halves are changed.
//
// A half speaks against the truth if
//
//   (a) the motion is beyond a failure bound of the truth;
//   (b) of the matches that only one of the two explains, more are the motion's than a coin gives: McNemar's
//       test, one-sided, p <= the level;
//   (c) of the blocks of image 1 (6 x 6) in which one explains more than the other, more are the motion's
//       than a coin gives: the sign test, which takes seven blocks at least at a level of .01. A moving
//       object or a repeated texture in a patch of the image does not pass, however many matches it has, nor
//       do matches that depend on their neighbours count more than once;
//   (d) the motion explains one and a half times as many matches as the truth, and at least 10. What an
//       error of the calibration makes of a right truth is less;
//   (e) nothing stands up for the truth, as it is given or as it is moved: of the matches that the motion
//       leaves, it explains no more than five, which any motion could be moved to, beside twice as many as of
//       random ones (each first point with another match's second), and in no block more than the motion
//       (each p > .01, over the blocks by Bonferroni). A second motion of most of the image does not make the
//       camera's, which the rest follows, doubtful.
//
// A half speaks for the truth if it does not speak against it, and the truth explains at least 10 matches and
// more than chance does (as in (e), of all matches). A front end doubts the truth if both halves speak
// against it; else the truth holds if one speaks for it, and if none does, the front end is silent. A pair is
// in doubt if a front end doubts the truth and it holds with none. The levels of (b) and (c) are .01 over the
// number of front ends (Bonferroni): where the truth explains matches no worse than the motion, (b) holds in
// a half with at most that probability, whatever the motion, since it does not depend on the half. So at most
// 1 % of pairs with a right truth are in doubt, and as both halves have to speak against it, far fewer.
//
// What matches cannot show: a second motion that all of the matches follow, as if the camera had moved so.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "estimator/motion_estimator.h"
#include "experiments/real/truth_check/truth_reach.h"

namespace rcme {

inline constexpr double kTruthDoubtLevel = 0.01;
inline constexpr double kLeastExplainedRatio = 1.5;
inline constexpr int kLeastExplainedByHalf = 10;

// The truth and another motion before the same matches.
struct TruthContest {
  RelativePose moved_truth;
  std::int64_t num_matches = 0;  // that count: one of each key point
  std::int64_t by_truth = 0, by_motion = 0, by_truth_only = 0, by_motion_only = 0;
  int blocks_of_truth = 0, blocks_of_motion = 0;
  double p_matches = 1.0, p_blocks = 1.0;  // (b), (c)
  double p_above_chance = 1.0;             // (e): that the truth explains more of the rest than twice chance
  double p_least_block = 1.0;              // (e): the least of the blocks, times their number
  double p_of_truth = 1.0;                 // that the truth explains more of all matches than twice chance

  double PValue() const;                        // the greater of (b) and (c)
  bool SpeaksAgainstTruth(double level) const;  // (b) to (e)
  bool SpeaksForTruth() const;
  void AddCounts(const TruthContest& other);  // matches and blocks
};
TruthContest CompareWithTruth(const MotionProblem& problem, const GivenTruth& truth,
                              const FailureBounds& bounds, const RelativePose& motion);

// The squares of the chessboard: whether each match lies in a white one.
std::vector<bool> IsInWhiteSquare(const MotionProblem& problem);

enum class TruthVerdict {
  kSilent,  // too little to say
  kHolds,
  kInDoubt,
};
// "silent", "holds", "in_doubt".
const char* Name(TruthVerdict verdict);

// What one front end's matches say, `num_front_ends` of the pair in all.
struct FrontEndEvidence {
  std::string front_end;
  TruthVerdict verdict = TruthVerdict::kSilent;
  TruthContest counts;   // of both halves together
  double p_value = 1.0;  // the greater of the halves'
  // Of the motion of all matches; NaN without one.
  double rotation_error_deg = 0.0, direction_error_deg = 0.0;
};
FrontEndEvidence WeighTruth(const MotionProblem& problem, const GivenTruth& truth,
                            const FailureBounds& bounds, const MotionEstimator& estimator, std::uint64_t seed,
                            size_t num_front_ends = 1);

// The verdict over all front ends of a pair, and the least p-value times their number.
struct PairVerdict {
  TruthVerdict verdict = TruthVerdict::kSilent;
  double p_value = 1.0;
};
PairVerdict JudgeTruth(const std::vector<FrontEndEvidence>& front_ends);

}  // namespace rcme
