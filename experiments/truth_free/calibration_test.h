// Is the calibration that all pairs of a set share right? A score test of camera faults, pooled over pairs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "estimator/geometry/camera.h"
#include "experiments/truth_free/camera_faults.h"
#include "experiments/truth_free/pair_answers.h"
#include "experiments/truth_free/truth_free_verdict.h"
#include "stats/pooled_scores.h"

namespace rcme {

// The five intervals of a set hold together with this confidence (Bonferroni: each with 0.99).
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
};

struct CalibrationReport {
  Camera camera;      // of the pairs
  int num_pairs = 0;  // that were taken: those that were taken by the same camera twice, the first pair's
  std::vector<FaultReport> faults;
  double p_value = 1.0;     // of there being none at all; NaN: cannot be said
  double dispersion = 0.0;  // by how much pairs scatter more, in variance, than independent errors would
  // Of all together: too large if p < 0.05 (there is some fault), holds if every one does.
  TruthFreeVerdict verdict = TruthFreeVerdict::kNoData;
};

// One Gauss-Newton step of self-calibration: theta = (sum A)^-1 sum s over the pairs (calibration_score.h),
// its interval from the scatter of pairs (stats/pooled_scores.h), so that it holds where a pair's errors are
// correlated and matches repeated.
CalibrationReport TestCalibration(const std::vector<PairAnswers>& answers);

// "focal length 0.52 % [0.45, 0.60] too long", "holds (within +-0.05 %)", "undecided: ...".
std::string FaultInWords(const FaultReport& report);
// "some fault (p = 0.001)", "holds", "undecided (p = 0.3)".
std::string CalibrationInWords(const CalibrationReport& report);
// What to change, a sentence for each fault that was found.
std::vector<std::string> CalibrationAdvice(const CalibrationReport& report);

}  // namespace rcme
