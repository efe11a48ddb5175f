// Tests from the matches alone, and with a known rate of false alarms, whether the given truth of a pair is
// wrong.
//
// The matches are divided into two halves that share no neighbourhood of image 1: the squares of a 12 x 12
// chessboard. An estimator finds a motion in one half. The other half, which it has not seen, decides
// between this motion and the truth. For this, the truth is moved within its reach to the motion that
// explains that half best (truth_reach.h). One match of each key point counts. A motion explains a match if
// it is right with a probability above one half. Both motions use the same mixture of right and wrong
// matches (calibrated/mixture_parameters.h), the one fitted to the motion with the greater likelihood. Then
// the halves are exchanged.
//
// A half speaks against the truth if
//
//   (a) the motion is beyond a failure bound of the truth;
//   (b) of the matches that only one of the two explains, significantly more are explained by the motion:
//       McNemar's test, one-sided, p <= the level;
//   (c) of the blocks of image 1 (6 x 6) in which one explains more matches than the other, significantly
//       more favour the motion: the sign test, which needs at least seven blocks at a level of .01. A moving
//       object or a repeated texture in one part of the image therefore does not suffice, however many
//       matches it has, and matches that depend on their neighbours count only once;
//   (d) the motion explains at least 1.5 times as many matches as the truth, and at least 10. An error of
//       the calibration has a smaller effect on a right truth;
//   (e) nothing supports the truth, neither as given nor as moved. Of the matches that the motion leaves
//       unexplained, the truth explains no more than five, to which any motion could be fitted, plus twice
//       as many as of random ones (each first point with another match's second point); and in no block does
//       the truth explain more than the motion (each p > .01, over the blocks by Bonferroni). A second
//       motion of most of the image thus casts no doubt on the camera's motion, which the rest follows.
//
// A half speaks for the truth if (a) and (b) are not both true, and the truth explains at least 10 matches
// and more than chance does (as in (e), of all matches). A front end doubts the truth if both halves speak
// against it. Otherwise the truth holds for this front end if a half speaks for it, and if none does, the
// front end is silent. A pair is in doubt if a front end doubts its truth and it holds for none.
//
// The levels of (b) and (c) are .01 over the number of front ends (Bonferroni). If the truth explains
// matches no worse than the motion, (b) holds in a half with at most this probability, whatever the motion
// is, because the motion does not depend on that half. So at most 1 % of the pairs with a right truth are in
// doubt; in fact far fewer, as both halves must speak against it.
//
// Matches cannot reveal a second motion that all of them follow, as if the camera had moved so.
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

// The comparison of the truth with another motion on the same matches.
struct TruthContest {
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
  void AddCounts(const TruthContest& other);  // adds matches and blocks
};
TruthContest CompareWithTruth(const MotionProblem& problem, const GivenTruth& truth,
                              const FailureBounds& bounds, const RelativePose& motion);

// Returns for each match whether it lies in a white square of the chessboard.
std::vector<bool> IsInWhiteSquare(const MotionProblem& problem);

enum class TruthVerdict {
  kSilent,  // too little evidence
  kHolds,
  kInDoubt,
};
// Returns "silent", "holds" or "in_doubt".
const char* Name(TruthVerdict verdict);

// The evidence of one front end's matches; the pair has `num_front_ends` in all.
struct FrontEndEvidence {
  std::string front_end;
  TruthVerdict verdict = TruthVerdict::kSilent;
  TruthContest counts;   // of both halves together
  double p_value = 1.0;  // the greater of both halves
  // Errors of the motion found from all matches; NaN without a motion.
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
