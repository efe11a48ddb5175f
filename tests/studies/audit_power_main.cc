// How sharp the audit is: the share of seeds in which it calls a faulty estimator faulty and a sound one
// sound. Prints three tables (CSV; `scripts/results audit_power` makes those of
// results/audit_power):
//   rcme_audit_power faults [SEEDS, default 50] > faults.csv
//   rcme_audit_power sigma [SEEDS, default 20; half as many where cases are simulated] > sigma.csv
//   rcme_audit_power edges [SEEDS, default 200] > edges.csv
// `faults`: each claim about an estimator's answers, of doubles that are sound or have one fault
// (tests/test_support/answer_doubles.h); quick budget. `sigma`: standard deviations wrong by 1 to 20 %, quick
// and full; drawn: the statistic is drawn from its law, run: it comes from simulated cases. `edges`: a target
// whose truth lies on the border of what counts as nominal, at confidence 0.95: "holds" and "does not hold"
// are both false there.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>

#include "experiments/audit/claims/audit.h"
#include "experiments/audit/claims/call_estimator.h"
#include "experiments/audit/claims/case.h"
#include "experiments/audit/claims/claim_table.h"
#include "experiments/audit/claims/decide_check.h"
#include "experiments/audit/claims/design.h"
#include "experiments/audit/claims/sample_statistics.h"
#include "tests/test_support/answer_doubles.h"

namespace rcme {
namespace {

// The true motion with errors of the Cramer-Rao bound, which is also what is reported.
MotionEstimate SoundAnswer(Case& made) {
  return AnswerWithErrors(made.pose_true(), CramerRaoBound(made).value(), made.rng);
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
Check DrawnCheck(int degrees_of_freedom, double sigma_error, const std::vector<Target>& targets,
                 const TrialLimits& limits) {
  Check check;
  check.targets = targets;
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
  std::int64_t most_trials = 0;
};

Verdicts Decide(const Claim& claim, Budget budget, int num_seeds, double confidence) {
  Verdicts verdicts;
  for (int seed = 1; seed <= num_seeds; ++seed) {
    std::vector<std::optional<Verdict>> of_checks;
    for (size_t c = 0; c < claim.checks.size(); ++c) {
      const CheckRun run{static_cast<std::uint64_t>(seed), static_cast<std::uint32_t>(7 + c), budget,
                         confidence, 0};
      const CheckResult result = DecideCheck(claim.checks[c], run);
      of_checks.push_back(result.verdict);
      verdicts.most_trials = std::max(verdicts.most_trials, result.num_trials);
      if (result.verdict == Verdict::kDoesNotHold) break;
    }
    const std::optional<Verdict> together = Together(of_checks);
    verdicts.caught += together == Verdict::kDoesNotHold;
    verdicts.holds += together == Verdict::kHolds;
    ++verdicts.seeds;
  }
  return verdicts;
}

// Both counts with exact 95 % intervals.
std::string CountsAsCsv(const Verdicts& verdicts) {
  const Interval caught = ExactBinomialInterval(verdicts.caught, verdicts.seeds);
  const Interval holds = ExactBinomialInterval(verdicts.holds, verdicts.seeds);
  return fmt::format("{},{},{:.3f},{:.3f},{},{:.3f},{:.3f}", verdicts.seeds, verdicts.caught, caught.lower,
                     caught.upper, verdicts.holds, holds.lower, holds.upper);
}

void PrintLine(const std::string& line) {
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

constexpr const char* kColumns =
    "seeds,does_not_hold,does_not_hold_lower,does_not_hold_upper,holds,holds_lower,holds_upper";

// Every claim about an estimator's answers, of every double.
void PrintFaults(double confidence, int num_seeds) {
  PrintLine(fmt::format("fault,claim,{},most_trials", kColumns));
  for (const DoubledFault& fault : DoubledFaults()) {
    for (const CaseClaim& claim :
         AnswerCalibration("double", "double", std::make_shared<DoubledEstimator>(fault), FailureBounds())) {
      Claim of_double;
      of_double.checks = {CheckOfDoubles(claim)};
      const Verdicts verdicts = Decide(of_double, Budget::kQuick, num_seeds, confidence);
      const std::string name = claim.words.id.substr(0, claim.words.id.rfind('.'));
      PrintLine(
          fmt::format("\"{}\",{},{},{}", fault.name, name, CountsAsCsv(verdicts), verdicts.most_trials));
    }
  }
}

// A statistic of the target's kind whose rate or mean is `truth`.
double DrawAt(const Target& target, double truth, RandomStream& rng) {
  switch (target.kind) {
    case Target::Kind::kMeanPit: {  // whose border is what such a sigma does
      const double off = 1.0 + kEstimatorTolerance.mean_pit, scale = truth > 0.5 ? off : 1.0 / off;
      double sum = 0.0;
      for (int i = 0; i < target.degrees_of_freedom; ++i) sum += std::pow(scale * rng.Normal(), 2.0);
      return sum;
    }
    case Target::Kind::kCoverage:
      return rng.Uniform() < truth ? 0.0 : 2.0 * target.threshold;
    case Target::Kind::kBoundedMean: {
      const bool is_of_events =
          target.allowed.lower <= target.range.lower;  // as failures are: 0, or rarely 1
      return is_of_events ? (rng.Uniform() < truth ? 1.0 : 0.0) : truth + (rng.Uniform() < 0.5 ? 0.1 : -0.1);
    }
    default:
      return rng.Uniform() < truth ? 1.0 : 0.0;
  }
}

Check EdgeCheck(Target target, double truth) {
  target.statistic = 0;
  Check check;
  check.targets = {target};
  check.limits = {0, 16'000, 16'000};
  check.trial = [target, truth](const StreamName& name) -> Outcome {
    RandomStream rng(name);
    return {DrawAt(target, truth, rng)};
  };
  return check;
}

// Both ends of what counts as nominal, of every target of the claims about an estimator's answers.
void PrintEdges(int num_seeds) {
  constexpr double kConfidence = 0.95;
  PrintLine(fmt::format("claim,quantity,border,{}", kColumns));
  const DoubledFault& sound = DoubledFaults().front();
  for (const CaseClaim& claim :
       AnswerCalibration("double", "double", std::make_shared<DoubledEstimator>(sound), FailureBounds())) {
    const std::string name = claim.words.id.substr(0, claim.words.id.rfind('.'));
    for (const Target& target : claim.targets) {
      if (!target.IsClaimed()) continue;
      for (const double border : {target.allowed.lower, target.allowed.upper}) {
        if (border <= target.range.lower || border >= target.range.upper) continue;
        Claim at_border;
        at_border.checks = {EdgeCheck(target, border)};
        const Verdicts verdicts = Decide(at_border, Budget::kQuick, num_seeds, kConfidence);
        PrintLine(fmt::format("{},\"{}\",{:.6g},{}", name, target.quantity, border, CountsAsCsv(verdicts)));
      }
    }
  }
}

void PrintSigma(double confidence, int num_seeds) {
  const int num_run = (num_seeds + 1) / 2;
  PrintLine(fmt::format("claim,statistic,budget,sigma_error,{}", kColumns));
  const auto row = [&](const std::string& words, double error, const Claim& claim, Budget budget, int seeds) {
    PrintLine(fmt::format("{},{},{:g},{}", words, budget == Budget::kQuick ? "quick" : "full", error,
                          CountsAsCsv(Decide(claim, budget, seeds, confidence))));
  };
  for (const double size : {0.0, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.08, 0.1, 0.15, 0.2}) {
    for (const double error : {size, -size}) {
      if (size == 0.0 && std::signbit(error)) continue;
      Claim covariance, point;
      covariance.checks.assign(
          2, DrawnCheck(5, error, CoverageTargets(5, kEstimatorTolerance), kEstimatorCoverage.limits));
      point.checks = {DrawnCheck(1, error, CoverageTargets(1), kSampleCoverage.limits)};
      for (const Budget budget : {Budget::kQuick, Budget::kFull}) {
        row("estimator,drawn", error, covariance, budget, num_seeds);
        row("known motion,drawn", error, point, budget, num_seeds);
      }
    }
  }
  for (const double error : {-0.1, -0.08, -0.05, 0.0, 0.05, 0.08, 0.1}) {
    const double assumed = (1.0 + error) * (1.0 + error);
    const auto answer = [assumed](Case& made) {
      MotionEstimate estimate = SoundAnswer(made);
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
  const std::string_view seeds = argc > 2            ? argv[2]
                                 : table == "edges"  ? "200"
                                 : table == "faults" ? "50"
                                                     : "20";
  int num_seeds = 0;
  std::from_chars(seeds.data(), seeds.data() + seeds.size(), num_seeds);
  if (argc > 3 || num_seeds < 1 || (table != "faults" && table != "sigma" && table != "edges")) {
    fmt::print(stderr, "usage: rcme_audit_power faults|sigma|edges [SEEDS] > TABLE.csv\n");
    return 2;
  }
  const double confidence = rcme::PlanAudit(rcme::AllClaims(rcme::EstimatorRegistry()), {}).confidence;
  if (table == "faults") {
    rcme::PrintFaults(confidence, num_seeds);
  } else if (table == "sigma") {
    rcme::PrintSigma(confidence, num_seeds);
  } else {
    rcme::PrintEdges(num_seeds);
  }
  return 0;
}
