// How sharp the audit is: the share of seeds in which it calls a faulty estimator faulty and a sound one
// sound. Prints two tables (CSV; `scripts/results audit_power` makes those of
// experiments/results/audit_power):
//   rcme_audit_power faults [SEEDS, default 20] > faults.csv
//   rcme_audit_power sigma [SEEDS, default 20; half as many where cases are simulated] > sigma.csv
// `faults`: test doubles answer the problems of the estimator claims with the true motion plus small errors,
// and with one fault; decided at the quick budget. `sigma`: standard deviations wrong by 1 to 20 %, quick and
// full; drawn: the statistic is drawn from its law, run: it comes from simulated cases.

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>

#include "experiments/claims/audit.h"
#include "experiments/claims/call_estimator.h"
#include "experiments/claims/claim_table.h"
#include "experiments/claims/cramer_rao.h"
#include "experiments/claims/decide_check.h"
#include "experiments/claims/design.h"
#include "experiments/claims/sample_statistics.h"

namespace rcme {
namespace {

using Spoil = void (*)(MotionEstimate* answer, RandomStream& rng);

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kDegPerRad = 180.0 / std::numbers::pi;

bool InOneOfTen(RandomStream& rng) { return rng.Uniform() < 0.1; }

struct Fault {
  const char* name;
  Spoil spoil;
};

// A right perturbation, R Exp(w'), has w = R w'.
void ReportInRightCoordinates(MotionEstimate* answer, RandomStream&) {
  Matrix5d turn = Matrix5d::Identity();
  turn.topLeftCorner<3, 3>() = answer->cam2_from_cam1.R.transpose();
  answer->pose_cov = turn * answer->pose_cov * turn.transpose();
}

const std::vector<Fault>& Faults() {
  static const std::vector<Fault> faults = {
      {"sound twin", [](MotionEstimate*, RandomStream&) {}},
      {"NaN in R in 10 % of the trials",
       [](MotionEstimate* a, RandomStream& rng) {
         if (InOneOfTen(rng)) a->cam2_from_cam1.R(1, 2) = kNaN;
       }},
      {"NaN in t in 10 % of the trials",
       [](MotionEstimate* a, RandomStream& rng) {
         if (InOneOfTen(rng)) a->cam2_from_cam1.t(0) = kNaN;
       }},
      {"NaN in the covariance in 10 % of the trials",
       [](MotionEstimate* a, RandomStream& rng) {
         if (InOneOfTen(rng)) a->pose_cov(3, 3) = kNaN;
       }},
      {"t = 0", [](MotionEstimate* a, RandomStream&) { a->cam2_from_cam1.t.setZero(); }},
      {"reflection instead of a rotation",
       [](MotionEstimate* a, RandomStream&) { a->cam2_from_cam1.R.col(2) *= -1.0; }},
      {"1000 R", [](MotionEstimate* a, RandomStream&) { a->cam2_from_cam1.R *= 1000.0; }},
      {"asymmetric covariance",
       [](MotionEstimate* a, RandomStream&) {
         a->pose_cov(0, 1) += 0.1 * std::sqrt(a->pose_cov(0, 0) * a->pose_cov(1, 1));
       }},
      {"one axis of the covariance in degrees",
       [](MotionEstimate* a, RandomStream&) {
         a->pose_cov.row(1) *= kDegPerRad;
         a->pose_cov.col(1) *= kDegPerRad;
       }},
      {"covariance of a right perturbation", ReportInRightCoordinates}};
  return faults;
}

// The true motion with errors of a hundredth of the Cramer-Rao bound's, which is also what is reported: so
// small that the tangent at the answer is that at the truth.
MotionEstimate SoundAnswer(const Case& made, RandomStream& rng) {
  MotionEstimate answer;
  answer.status = MotionStatus::kOk;
  answer.pose_cov = 1e-4 * CramerRaoBound(made).value();
  Vector5d normal;
  for (double& each : normal) each = rng.Normal();
  answer.cam2_from_cam1 = Retract(made.pose_true(), answer.pose_cov.llt().matrixL() * normal);
  return answer;
}

// The claim about an estimator's covariance, with answers of a test double.
Claim ClaimOn(const std::function<MotionEstimate(Case&)>& answer) {
  Claim claim;
  for (const char* outlier_ratio : {"0", "0.2"}) {
    claim.checks.push_back(MakeCheck(
        {{"num_matches", "100"}, {"outlier_ratio", outlier_ratio}},
        [answer](Case& made) { return CovarianceStatistic(Score(answer(made), made.data, 0.0), made); },
        ReportedCovarianceTargets(), kEstimatorCoverage.limits));
  }
  return claim;
}

// A check whose statistic is chi-square distributed, with assumed standard deviations too large by
// `sigma_error`.
Check DrawnCheck(int degrees_of_freedom, double sigma_error, const TrialLimits& limits) {
  Check check;
  check.targets = CoverageTargets(degrees_of_freedom);
  check.limits = limits;
  check.trial = [degrees_of_freedom, assumed = 1.0 + sigma_error](const StreamName& name) -> Outcome {
    RandomStream rng(name);
    double sum = 0.0;
    for (int i = 0; i < degrees_of_freedom; ++i) sum += std::pow(rng.Normal() / assumed, 2.0);
    return {sum};
  };
  return check;
}

struct Verdicts {
  int caught = 0, holds = 0, seeds = 0;
};

Verdicts Decide(const Claim& claim, Budget budget, int num_seeds, double confidence) {
  Verdicts verdicts;
  for (int seed = 1; seed <= num_seeds; ++seed) {
    ClaimResult result;
    for (size_t c = 0; c < claim.checks.size(); ++c) {
      const CheckRun run{static_cast<std::uint64_t>(seed), static_cast<std::uint32_t>(7 + c), budget,
                         confidence, 0};
      result.checks.push_back(DecideCheck(claim.checks[c], run));
      if (result.checks.back().verdict == Verdict::kDoesNotHold) break;
    }
    const bool is_caught = result.checks.back().verdict == Verdict::kDoesNotHold;
    bool holds = true;
    for (const CheckResult& check : result.checks) holds &= check.verdict == Verdict::kHolds;
    verdicts.caught += is_caught;
    verdicts.holds += holds;
    ++verdicts.seeds;
  }
  return verdicts;
}

void PrintRow(const std::string& what, const Verdicts& verdicts) {
  const Interval caught = ExactBinomialInterval(verdicts.caught, verdicts.seeds);
  const Interval holds = ExactBinomialInterval(verdicts.holds, verdicts.seeds);
  fmt::print("{},{},{},{:.3f},{:.3f},{},{:.3f},{:.3f}\n", what, verdicts.seeds, verdicts.caught, caught.lower,
             caught.upper, verdicts.holds, holds.lower, holds.upper);
  std::fflush(stdout);
}

constexpr const char* kColumns =
    "seeds,does_not_hold,does_not_hold_lower,does_not_hold_upper,holds,holds_lower,holds_upper";

void PrintFaults(double confidence, int num_seeds) {
  fmt::print("fault,{}\n", kColumns);
  for (const Fault& fault : Faults()) {
    const Claim claim = ClaimOn([spoil = fault.spoil](Case& made) {
      MotionEstimate answer = SoundAnswer(made, made.rng);
      spoil(&answer, made.rng);
      return answer;
    });
    PrintRow(fault.name, Decide(claim, Budget::kQuick, num_seeds, confidence));
  }
}

void PrintSigma(double confidence, int num_seeds) {
  const int num_run = (num_seeds + 1) / 2;
  fmt::print("claim,statistic,budget,sigma_error,{}\n", kColumns);
  const auto row = [&](const std::string& words, double error, const Claim& claim, Budget budget, int seeds) {
    PrintRow(fmt::format("{},{},{:g}", words, budget == Budget::kQuick ? "quick" : "full", error),
             Decide(claim, budget, seeds, confidence));
  };
  for (const double size : {0.0, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.08, 0.1, 0.15, 0.2}) {
    for (const double error : {size, -size}) {
      if (size == 0.0 && std::signbit(error)) continue;
      Claim covariance, point;
      covariance.checks.assign(2, DrawnCheck(5, error, kEstimatorCoverage.limits));
      point.checks = {DrawnCheck(1, error, kSampleCoverage.limits)};
      for (const Budget budget : {Budget::kQuick, Budget::kFull}) {
        row("estimator,drawn", error, covariance, budget, num_seeds);
        row("known motion,drawn", error, point, budget, num_seeds);
      }
    }
  }
  for (const double error : {-0.1, -0.05, 0.0, 0.05, 0.1}) {
    const double assumed = (1.0 + error) * (1.0 + error);
    const auto answer = [assumed](Case& made) {
      MotionEstimate estimate = SoundAnswer(made, made.rng);
      estimate.pose_cov *= assumed;
      return estimate;
    };
    Claim point;
    point.checks = {MakeCheck(
        {{"num_matches", "1"}},
        [error](Case& made) {
          made.data.problem.sigma_px *= 1.0 + error;
          return TruePoseStatistic(RankAwareDistance)(made);
        },
        CoverageTargets(1), kSampleCoverage.limits)};
    row("estimator,run", error, ClaimOn(answer), Budget::kQuick, num_run);
    row("known motion,run", error, point, Budget::kQuick, num_run);
  }
}

}  // namespace
}  // namespace rcme

int main(int argc, char** argv) {
  const std::string table = argc > 1 ? argv[1] : "";
  const std::string_view seeds = argc > 2 ? argv[2] : "20";
  int num_seeds = 0;
  std::from_chars(seeds.data(), seeds.data() + seeds.size(), num_seeds);
  if (argc > 3 || num_seeds < 1 || (table != "faults" && table != "sigma")) {
    fmt::print(stderr, "usage: rcme_audit_power faults|sigma [SEEDS] > TABLE.csv\n");
    return 2;
  }
  const double confidence = rcme::PlanAudit(rcme::AllClaims(rcme::EstimatorRegistry()), {}).confidence;
  if (table == "faults") {
    rcme::PrintFaults(confidence, num_seeds);
  } else {
    rcme::PrintSigma(confidence, num_seeds);
  }
  return 0;
}
