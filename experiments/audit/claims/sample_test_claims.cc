#include <fmt/format.h>

#include "estimator/sample_consistency.h"
#include "experiments/audit/claims/calibration.h"
#include "experiments/audit/claims/design.h"
#include "experiments/audit/claims/families.h"
#include "experiments/audit/claims/sample_statistics.h"
#include "stats/constants.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

constexpr double kSignificanceLevel = 0.05;
const char* const kSampleTestLabel = "eq::sample-p-test";

Outcome JointStatistic(Case& made) {
  const std::optional<Hypothesis<EightPoint>> hypothesis = FitEightPoints(made.problem());
  return {hypothesis ? JointSampleStatistic(*hypothesis) : kInfinity};
}

// Whether every point of the sample passes on its own.
bool EveryPointPasses(const MotionProblem& problem) {
  const std::optional<Hypothesis<EightPoint>> hypothesis = FitEightPoints(problem);
  if (!hypothesis) return false;
  const std::optional<UncertainFundamental> model =
      UncertainFundamental::From(hypothesis->pose, hypothesis->pose_cov, problem.camera1, problem.camera2);
  return model && EverySamplePointFits(problem, *hypothesis, AsPrintedTest(*model, problem.sigma_px),
                                       ChiSquareQuantile(3, 1.0 - kSignificanceLevel));
}

// Whether the first point passes, and whether all eight do.
Outcome PassesPerPointStatistic(Case& made) {
  const double distance = OwnPointStatistic(AsPrintedDistance)(made)[0];
  return {distance <= ChiSquareQuantile(3, 1.0 - kSignificanceLevel) ? 1.0 : 0.0,
          EveryPointPasses(made.problem()) ? 1.0 : 0.0};
}

Outcome RejectedPerPointStatistic(Case& made) { return {EveryPointPasses(made.problem()) ? 0.0 : 1.0}; }

Outcome RejectedJointlyStatistic(Case& made) {
  return {JointStatistic(made)[0] <= ChiSquareQuantile(3, 1.0 - kSignificanceLevel) ? 0.0 : 1.0};
}

// One check per number of outliers in the sample, 1 to 8.
std::vector<Check> PowerChecks(const Statistic& is_rejected) {
  std::vector<Check> checks;
  for (int num_outliers = 1; num_outliers <= 8; ++num_outliers) {
    Check check =
        MakeCheck({{"num_matches", "8"}, {"outlier_ratio", fmt::format("{}", num_outliers / 8.0)}},
                  is_rejected, {PlannedRate("share rejected", 1.0, kPowerOfTest)}, kPowerOfTest.limits);
    check.conditions.emplace_back("num_outliers", fmt::format("{}", num_outliers));
    checks.push_back(std::move(check));
  }
  return checks;
}

}  // namespace

std::vector<CaseClaim> SampleTestCalibration() {
  return {{{"sample_test.size.joint",
            kSampleTestLabel,
            "joint, 3 dof",
            "A sample without outliers passes with probability 1 - alpha",
            "T = (N'f)' (N' Sigma_f N)^-1 (N'f), chi2_3",
            "sigma_px",
            {}},
           JointStatistic,
           CoverageTargets(3),
           kSampleCoverage.limits,
           {.true_motion = false}}};
}

std::vector<Claim> SampleTestClaims() {
  const char* kPower = "At least 90 % of samples with 1 to 8 mismatches are rejected";
  const Settings sample = {{"num_matches", "8"}};
  return {
      {"sample_test.size.as_printed", kSampleTestLabel, "per point",
       "A point of a sample without outliers passes with probability 1 - alpha = 0.95",
       "delta' Sigma_delta^-1 delta <= chi2_3", "sigma_px",
       ChecksAtNoiseLevels(kNoiseLevelsPx, sample, PassesPerPointStatistic,
                           {PlannedRate("points that pass", 0.95, kPerPointLevel),
                            MeasuredRate("samples of which all eight points pass", 1)},
                           kPerPointLevel.limits)},
      AtNoiseLevels(SampleTestCalibration().front(), kNoiseLevelsPx, sample),
      {"sample_test.power.as_printed", kSampleTestLabel, "per point", kPower,
       "a point exceeds chi2_3 at alpha = 0.05", "num_outliers", PowerChecks(RejectedPerPointStatistic)},
      {"sample_test.power.joint", kSampleTestLabel, "joint, 3 dof", kPower,
       "T exceeds chi2_3 at alpha = 0.05", "num_outliers", PowerChecks(RejectedJointlyStatistic)},
  };
}

}  // namespace rcme
