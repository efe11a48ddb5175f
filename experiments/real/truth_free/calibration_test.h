// Is the calibration that all pairs of a set share right? A score test of camera faults, pooled over pairs.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "estimator/geometry/camera.h"
#include "experiments/real/truth_free/camera_faults.h"
#include "experiments/real/truth_free/pair_answers.h"
#include "experiments/real/truth_free/truth_free_verdict.h"
#include "stats/pooled_scores.h"

namespace rcme {

// The intervals of all named faults of a set hold together with this confidence (Bonferroni).
inline constexpr double kFaultConfidence = 0.95;

struct FaultReport {
  CameraFault fault = CameraFault::kFocalLength;
  // Estimated beside the other faults; were it the only one; the former of the twins, which have none.
  PooledParameter joint, alone, twins;
  // By `joint`: holds if the whole interval is nominal, too large or too small if it does not hold zero; by
  // nothing ("undecided") where the twins show one too, and the pairs' interval does not lie beyond theirs.
  TruthFreeVerdict verdict = TruthFreeVerdict::kNoData;
  // Where it is undecided, but is found if it is the only fault: the one that it is told apart from worst.
  std::optional<CameraFault> confused_with;
  double pairs_needed = 0.0;  // where it is undecided: so many in all would decide it, about; 0: not known
  double correction =
      0.0;  // where it is named: what makes the test of all faults hold, beside the others named
};

struct CalibrationReport {
  Camera camera;      // of the pairs
  int num_pairs = 0;  // that were taken: those that were taken by the same camera twice, the first pair's
  std::vector<FaultReport> faults;  // a readout time only of pairs that state the time between their images
  double p_value = 1.0;             // of there being none at all; NaN: cannot be said
  double dispersion = 0.0;  // by how much pairs scatter more, in variance, than independent errors would
  // Of all together: too large if p < 0.05 (there is some fault), holds if every one does.
  TruthFreeVerdict verdict = TruthFreeVerdict::kNoData;
  std::string why_unnamed;  // why no fault is named though an interval does not hold zero; empty: none is
  bool is_of_other_kind = false;  // what is left where they are corrected is of a kind that is never named
  int num_steps = 1;              // of the self-calibration
  double p_corrected = std::numeric_limits<double>::quiet_NaN();  // p_value where what is named is corrected
};

// One Gauss-Newton step of self-calibration: theta = (sum A)^-1 sum s over the pairs (calibration_score.h),
// its interval from the scatter of pairs (stats/pooled_scores.h), so that it holds where a pair's errors are
// correlated and matches repeated. Nothing is named (verdicts are undecided) where
//   - the test of all faults together is not rejected at 5 %;
//   - the step leaves the range in which it is linear: the interval of some fault covers half of what is
//     physically possible, or its value lies beyond that (GreatestFault).
CalibrationReport TestCalibration(const std::vector<PairAnswers>& answers);

// What the scores of the pairs say of faults, before anything is judged.
struct FaultEstimates {
  Camera camera;
  int num_pairs = 0;
  std::vector<CameraFault> asked;       // the columns of what is pooled
  std::vector<UnitScore> units, twins;  // of all faults
};
FaultEstimates EstimateFaults(const std::vector<PairAnswers>& answers);
// Of some of the faults, the others taken to be zero.
PooledScores PoolFaults(const std::vector<UnitScore>& units, const std::vector<CameraFault>& faults);
// A fault that is never named and explains something: the most certain one, at 5 % for all.
std::optional<CameraFault> FindOtherFault(const std::vector<UnitScore>& units);

// Sets the verdicts of all faults and of all together from the estimates and p_value.
void JudgeFaults(CalibrationReport* report);
bool NamesFault(const CalibrationReport& report);
// Takes all names back.
void NameNothing(std::string why, CalibrationReport* report);
bool IsFault(TruthFreeVerdict verdict);

// In units of which a pair's readout is a share: the median time between images over its own. One where it is
// not known.
std::vector<double> ReadoutScales(const std::vector<PairAnswers>& answers);

// "focal length 0.52 % [0.45, 0.60] too long", "holds (within +-0.05 %)", "undecided: ...".
std::string DescribeFault(const FaultReport& report);
// "some fault (p = 0.001)", "holds", "undecided (p = 0.3)".
std::string DescribeCalibration(const CalibrationReport& report);
// What to change, a sentence for each fault that was found.
std::vector<std::string> CalibrationAdvice(const CalibrationReport& report);

}  // namespace rcme
