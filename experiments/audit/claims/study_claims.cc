#include "experiments/audit/claims/study_claims.h"

#include <algorithm>

#include "experiments/audit/claims/calibration.h"
#include "experiments/audit/claims/study_cases.h"
#include "experiments/trial/simulate_draw.h"
#include "stats/constants.h"

namespace rcme {
namespace {

std::vector<CaseClaim> ListCalibrationClaims(const StudyPlan& plan) {
  std::vector<CaseClaim> all;
  for (const std::vector<CaseClaim>& family :
       {SigmaFCalibration(), SigmaPCalibration(), InlierCalibration(), SampleTestCalibration(),
        EntropyCalibration(), MleCalibration()}) {
    all.insert(all.end(), family.begin(), family.end());
  }
  for (size_t e = 0; e < plan.estimators.size(); ++e) {
    const EstimatorSpec& spec = plan.study.estimators[e];
    const std::vector<CaseClaim> of_answers = AnswerCalibration(
        spec.label, spec.name + ", options of the study", plan.estimators[e], plan.study.failure);
    all.insert(all.end(), of_answers.begin(), of_answers.end());
  }
  return all;
}

using SimulatedCase = SimulatedDraw<Case>;

// A condition of the study, with its first trials to see what they hold.
struct ConditionCases {
  Settings levels;  // factor, level
  std::function<SimulatedCase(const StreamName&)> make;
  std::vector<SimulatedCase> first;
};

ConditionCases MakeConditionCases(const StudyPlan& plan, const Condition& condition) {
  constexpr std::uint32_t kNumFirst = 16;
  const auto make = [study = plan.study, make_case = StudyCases(plan, condition)](const StreamName& name) {
    return SimulateDraw(study, [&] { return make_case(name); });
  };
  ConditionCases cases{{}, make, {}};
  for (size_t f = 0; f < plan.factor_names.size(); ++f) {
    cases.levels.emplace_back(plan.factor_names[f], condition.levels[f]);
  }
  for (std::uint32_t trial = 0; trial < kNumFirst; ++trial) {
    cases.first.push_back(cases.make(NameOfTrial(plan, condition, trial)));
  }
  return cases;
}

// Why a trial gives no statistic with these needs; empty if it gives one.
std::string WhyNoStatistic(const SimulatedCase& simulated, const CaseNeeds& needs) {
  if (simulated.made) return WhatIsMissing(*simulated.made, needs);
  return StatusName(MotionStatus::kNotSimulated) + ": " + simulated.why_not;
}

// What all of the first trials lack; empty if at least one lacks nothing.
std::string WhatAllLack(const std::vector<SimulatedCase>& cases, const CaseNeeds& needs) {
  std::string missing;
  for (const SimulatedCase& simulated : cases) {
    missing = WhyNoStatistic(simulated, needs);
    if (missing.empty()) break;
  }
  return missing;
}

size_t NumStatistics(const std::vector<Target>& targets) {
  size_t count = 0;
  for (const Target& target : targets) count = std::max(count, target.statistic + 1);
  return count;
}

Check CheckOn(const ConditionCases& cases, const CaseClaim& claim) {
  Check check;
  check.conditions = cases.levels;
  check.sigma_px.reset();
  check.not_possible = WhatAllLack(cases.first, claim.needs);
  if (!check.not_possible.empty()) return check;
  check.targets = claim.targets;
  check.limits = claim.limits;
  check.difficulty_statistic = claim.difficulty_statistic;
  check.not_stated = claim.not_stated;
  const Outcome nothing(NumStatistics(claim.targets), kNaN);
  check.trial = [make = cases.make, statistic = claim.statistic, needs = claim.needs,
                 nothing](const StreamName& name) {
    SimulatedCase simulated = make(name);
    if (!WhyNoStatistic(simulated, needs).empty()) return nothing;
    KeepWhatIsNeeded(&simulated.made->data, needs);
    return statistic(*simulated.made);
  };
  return check;
}

}  // namespace

std::vector<Claim> StudyClaims(const StudyPlan& plan) {
  RequireCases(plan.study);
  std::vector<CaseClaim> calibration = ListCalibrationClaims(plan);
  std::vector<Claim> claims;
  for (const CaseClaim& claim : calibration) {
    claims.push_back(claim.words);
    claims.back().figure_x = plan.factor_names.size() == 1 ? plan.factor_names.front() : "";
  }
  for (const Condition& condition : plan.conditions) {
    const ConditionCases cases = MakeConditionCases(plan, condition);
    for (size_t i = 0; i < claims.size(); ++i) claims[i].checks.push_back(CheckOn(cases, calibration[i]));
  }
  return claims;
}

}  // namespace rcme
