// Tests the calibration that all pairs of a set share: a score test of camera faults, pooled over the pairs.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "estimator/geometry/camera.h"
#include "experiments/real/truth_free/camera_faults.h"
#include "experiments/real/truth_free/pair_set.h"
#include "experiments/real/truth_free/truth_free_verdict.h"
#include "stats/pooled_scores.h"

namespace rcme {

// Joint confidence of the intervals of all named faults of a set (Bonferroni).
inline constexpr double kFaultConfidence = 0.95;

struct FaultReport {
  CameraFault fault = CameraFault::kFocalLength;
  // Estimated together with the other faults; estimated as the only fault; `joint` of the twins, which have
  // no fault.
  PooledParameter joint, alone, twins;
  // From `joint`: holds if the whole interval is nominal, too large or too small if the interval excludes
  // zero. It is undecided if the twins show this fault too and the pairs' interval does not lie beyond
  // theirs.
  TruthFreeVerdict verdict = TruthFreeVerdict::kNoData;
  // If `joint` is undecided but `alone` shows a fault: the fault that is hardest to distinguish from this
  // one.
  std::optional<CameraFault> confused_with;
  double pairs_needed = 0.0;  // if undecided: pairs in all that would decide, roughly; 0: not known
  // If named: the value whose correction, with those of the other named faults, passes the test of all
  // faults.
  double correction = 0.0;
};

struct CalibrationReport {
  Camera camera;                    // of the first pair
  int num_pairs = 0;                // pairs used: both images are of `camera`
  std::vector<FaultReport> faults;  // the readout time only if all pairs state the time between their images
  double p_value = 1.0;             // of the hypothesis of no fault at all; NaN: not known
  double dispersion = 0.0;          // variance between pairs over that expected for independent errors
  // Of all faults together: holds if each of them does, else too large (there is some fault) if p < 0.05.
  TruthFreeVerdict verdict = TruthFreeVerdict::kNoData;
  std::string why_unnamed;        // why no fault is named; may be empty
  bool is_of_other_kind = false;  // after correction a fault of a kind that is never named remains
  int num_steps = 1;              // of the self-calibration
  double p_corrected = std::numeric_limits<double>::quiet_NaN();  // p_value with the named faults corrected
};

// One Gauss-Newton step of self-calibration: theta = (sum A)^-1 sum s over the pairs (calibration_score.h).
// Its interval comes from the scatter between pairs (stats/pooled_scores.h), so it stays valid if errors
// within a pair are correlated or matches repeated. No fault is named (verdicts are undecided) if
//   - the test of all faults together does not reject at 5 %; or
//   - the step leaves its linear range: some fault's interval covers half of the physically possible range,
//   or
//     its value lies outside that range (GreatestFault).
CalibrationReport TestCalibration(const std::vector<PairAnswers>& answers);

// Scores of the pairs before any verdict.
struct FaultEstimates {
  Camera camera;
  int num_pairs = 0;
  std::vector<CameraFault> asked;       // the faults to estimate
  std::vector<UnitScore> units, twins;  // of all faults
};
FaultEstimates EstimateFaults(const std::vector<PairAnswers>& answers);
// Pools the scores of some faults; the others are taken to be zero.
PooledScores PoolFaults(const std::vector<UnitScore>& units, const std::vector<CameraFault>& faults);
// The most significant of the faults that are never named; nullopt if none is significant, at 5 % for all.
std::optional<CameraFault> FindOtherFault(const std::vector<UnitScore>& units);

// Sets the verdicts of all faults and of all together from the estimates and p_value.
void JudgeFaults(CalibrationReport* report);
bool NamesFault(const CalibrationReport& report);
// Makes the verdict on every named fault undecided.
void NameNothing(std::string why, CalibrationReport* report);
bool IsFault(TruthFreeVerdict verdict);

// For each pair, the factor by which a readout time relative to the median time between images is converted
// to the pair's own: median over own time. 1 if not known.
std::vector<double> ReadoutScales(const std::vector<PairAnswers>& answers);

// "focal length 0.52 % [0.45, 0.60] too long", "holds (within +-0.05 %)", "undecided: ...".
std::string DescribeFault(const FaultReport& report);
// "some fault (p = 0.001)", "holds", "undecided (p = 0.3)".
std::string DescribeCalibration(const CalibrationReport& report);
// What to change: one sentence for each named fault.
std::vector<std::string> CalibrationAdvice(const CalibrationReport& report);

}  // namespace rcme
