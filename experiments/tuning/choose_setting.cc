#include "experiments/tuning/choose_setting.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "experiments/audit/claims/claim_verdict.h"
#include "stats/constants.h"
#include "stats/intervals.h"
#include "stats/pareto_front.h"
#include "stats/risk_control.h"

namespace rcme {
namespace {

constexpr double kPower = 0.9;  // with which the recommended number of trials certifies

double RateOrOne(const ErrorCount& count) {
  return count.n > 0 ? static_cast<double>(count.errors) / static_cast<double>(count.n) : 1.0;
}

std::string DescribeRate(const ErrorCount& count) {
  const Interval interval = ExactBinomialInterval(count.errors, count.n);
  return fmt::format("{:.3g} % [{:.3g}, {:.3g}] of {}", 100.0 * RateOrOne(count), 100.0 * interval.lower,
                     100.0 * interval.upper, count.n);
}

// The rate to minimise among the settings that meet the target.
double Objective(const Tuning& tuning, const SettingCount& count) {
  return RateOrOne(tuning.target == TuneTarget::kFalseRefusal ? count.Failure() : count.Refusal());
}

// Whether the target limits refusals as well.
bool HasRefusalLimit(const Tuning& tuning) {
  return LimitsFailures(tuning.target) && tuning.max_refusal < 1.0;
}

// The p-value of "the setting violates the target".
double PValue(const Tuning& tuning, const SettingCount& count) {
  const double p = ExcessPValue(TargetedCount(tuning, count), tuning.at_most);
  return HasRefusalLimit(tuning) ? std::max(p, ExcessPValue(count.Refusal(), tuning.max_refusal)) : p;
}

// The settings worth testing: those for which no other has a lower rate of what the target limits and as good
// an objective. Settings that tie in this rate all stay, because the exploration may be too small to tell a
// safe one from a lucky one.
std::vector<size_t> Proposed(const Tuning& tuning, const std::vector<SettingCount>& counts) {
  std::vector<double> limited, objective;
  for (const SettingCount& count : counts) {
    limited.push_back(RateOrOne(TargetedCount(tuning, count)));
    objective.push_back(Objective(tuning, count));
  }
  return ParetoFront(limited, objective, TiesOfFirst::kStay);
}

// The proposed settings, ordered by how surely they meet the target. Of equals, the one with the greatest
// objective comes first, because it is the more careful one.
std::vector<size_t> OrderSettings(const Tuning& tuning, const std::vector<SettingCount>& explored) {
  std::vector<std::tuple<double, double, size_t>> path;
  for (const size_t s : Proposed(tuning, explored)) {
    path.emplace_back(PValue(tuning, explored[s]), -Objective(tuning, explored[s]), s);
  }
  std::ranges::sort(path);
  std::vector<size_t> settings;
  for (const auto& [p_value, objective, s] : path) settings.push_back(s);
  return settings;
}

// The setting nearest to being certified; if all are hopeless, the one nearest to the target's limits.
size_t NearestSetting(const Tuning& tuning, const std::vector<SettingCount>& calibrated) {
  const auto key = [&](size_t s) {
    const SettingCount& count = calibrated[s];
    const double excess =
        HasRefusalLimit(tuning) ? std::max(0.0, RateOrOne(count.Refusal()) - tuning.max_refusal) : 0.0;
    return std::tuple(PValue(tuning, count), excess, RateOrOne(TargetedCount(tuning, count)),
                      Objective(tuning, count));
  };
  size_t nearest = 0;
  for (size_t s = 1; s < calibrated.size(); ++s) {
    if (key(s) < key(nearest)) nearest = s;
  }
  return nearest;
}

std::int64_t DivideRoundingUp(std::int64_t numerator, std::int64_t denominator) {
  return (numerator + denominator - 1) / denominator;
}

// Why a count does not certify its limit: too few trials, or the rate itself. Empty if it does.
std::string Obstacle(const Tuning& tuning, const char* what, const ErrorCount& count, double at_most) {
  if (ExcessPValue(count, at_most) <= tuning.delta) return {};
  if (count.n == 0) {
    return fmt::format("{}: no trial {}", what,
                       tuning.target == TuneTarget::kAcceptedFailure
                           ? "is accepted"
                           : "would be good if nothing were refused");
  }
  const std::string figure = fmt::format("{} {}", what, DescribeRate(count));
  if (ExactBinomialInterval(count.errors, count.n).lower > at_most) {
    return figure + fmt::format(": {:.3g} % is out of reach", 100.0 * at_most);
  }
  if (RateOrOne(count) >= at_most) {
    return figure + fmt::format(", which is not below {:.3g} %", 100.0 * at_most);
  }
  const std::int64_t needed = TrialsToCertify(RateOrOne(count), at_most, tuning.delta, kPower);
  return figure + fmt::format(
                      ", too few trials: if that is the rate, {} certify {:.3g} % with probability {}: "
                      "calibrate: {} instead of {}",
                      needed, 100.0 * at_most, kPower, DivideRoundingUp(needed * tuning.calibrate, count.n),
                      tuning.calibrate);
}

std::string WhyNone(const Tuning& tuning, const std::vector<std::string>& settings,
                    const std::vector<SettingCount>& calibrated) {
  const size_t nearest = NearestSetting(tuning, calibrated);
  const bool is_failure = LimitsFailures(tuning.target);
  std::string why = Obstacle(tuning, is_failure ? "failure" : "false refusal",
                             TargetedCount(tuning, calibrated[nearest]), tuning.at_most);
  const std::string refusal =
      HasRefusalLimit(tuning) ? Obstacle(tuning, "refusal", calibrated[nearest].Refusal(), tuning.max_refusal)
                              : "";
  if (!why.empty() && !refusal.empty()) why += "; ";
  why += refusal;
  if (why.empty()) {
    why = fmt::format(
        "it could be certified, but one that seemed surer was not; explore more than {} trials of "
        "each condition, so that it comes first",
        tuning.explore);
  }
  return fmt::format("nearest is {}: {}; no setting is certified to meet the target ({})", settings[nearest],
                     why, DescribeTarget(tuning));
}

double UpperBound(const ErrorCount& count, double delta) {
  return ExactBinomialInterval(count.errors, count.n, 1.0 - 2.0 * delta).upper;
}

Choice ChooseLeastRisk(const Tuning& tuning, const std::vector<SettingCount>& explored,
                       const std::vector<SettingCount>& calibrated) {
  Choice choice;
  size_t best = 0;
  for (size_t s = 1; s < explored.size(); ++s) {
    if (Risk(tuning, explored[s]) < Risk(tuning, explored[best])) best = s;
  }
  choice.setting = best;
  choice.path = {best};
  const double half = 0.5 * tuning.delta;  // either bound may fail
  choice.risk_bound = tuning.cost_of_failure * UpperBound(calibrated[best].Failure(), half) +
                      tuning.cost_of_refusal * UpperBound(calibrated[best].Refusal(), half);
  return choice;
}

Verdict DecideSetting(const ErrorCount& count, double at_most) {
  return DecideEquivalence(ExactBinomialInterval(count.errors, count.n), {-kInfinity, at_most});
}

}  // namespace

ErrorCount TargetedCount(const Tuning& tuning, const SettingCount& count) {
  if (tuning.target == TuneTarget::kFalseRefusal) return count.FalseRefusal();
  return tuning.target == TuneTarget::kAcceptedFailure ? count.AcceptedFailure() : count.Failure();
}

Verdict DecideSetting(const Tuning& tuning, const SettingCount& count) {
  std::vector<std::optional<Verdict>> verdicts = {
      DecideSetting(TargetedCount(tuning, count), tuning.at_most)};
  if (HasRefusalLimit(tuning)) verdicts.emplace_back(DecideSetting(count.Refusal(), tuning.max_refusal));
  return *Together(verdicts);
}

double Risk(const Tuning& tuning, const SettingCount& count) {
  return tuning.cost_of_failure * RateOrOne(count.Failure()) +
         tuning.cost_of_refusal * RateOrOne(count.Refusal());
}

Choice ChooseSetting(const Tuning& tuning, const std::vector<std::string>& settings,
                     const std::vector<SettingCount>& explored, const std::vector<SettingCount>& calibrated) {
  if (tuning.target == TuneTarget::kRisk) return ChooseLeastRisk(tuning, explored, calibrated);
  Choice choice;
  choice.path = OrderSettings(tuning, explored);
  std::vector<double> p_values;
  for (const size_t s : choice.path) p_values.push_back(PValue(tuning, calibrated[s]));
  choice.num_certified = CountCertified(p_values, tuning.delta);
  if (choice.num_certified == 0) {
    choice.why = WhyNone(tuning, settings, calibrated);
    return choice;
  }
  const auto certified = choice.path.begin() + static_cast<std::ptrdiff_t>(choice.num_certified);
  choice.setting = *std::min_element(choice.path.begin(), certified, [&](size_t a, size_t b) {
    return Objective(tuning, calibrated[a]) < Objective(tuning, calibrated[b]);
  });
  return choice;
}

std::string WhyTooFewTrials(const Tuning& tuning, size_t num_conditions) {
  if (tuning.target == TuneTarget::kRisk) return {};
  const double strictest =
      HasRefusalLimit(tuning) ? std::min(tuning.at_most, tuning.max_refusal) : tuning.at_most;
  const auto conditions = static_cast<std::int64_t>(num_conditions);
  const std::int64_t num_trials = tuning.calibrate * conditions;
  const std::int64_t needed = FewestCertifyingTrials(strictest, tuning.delta);
  if (num_trials >= needed) return {};
  return fmt::format(
      "calibrate: {} in each of {} conditions cannot certify {:.3g} % at delta {}, whatever they show: {} "
      "trials would do if none of them erred, calibrate: {}",
      tuning.calibrate, conditions, 100.0 * strictest, tuning.delta, needed,
      DivideRoundingUp(needed, conditions));
}

std::string DescribeTarget(const Tuning& tuning) {
  switch (tuning.target) {
    case TuneTarget::kFalseRefusal:
      return fmt::format(
          "at most {:.3g} % of the trials that would be good if nothing were refused are refused, except "
          "with "
          "probability {}; then the least failure",
          100.0 * tuning.at_most, tuning.delta);
    case TuneTarget::kAcceptedFailure:
      return fmt::format(
          "at most {:.3g} % of the trials that are not refused fail and at most {:.3g} % are refused, except "
          "with probability {}; then the least refusal",
          100.0 * tuning.at_most, 100.0 * tuning.max_refusal, tuning.delta);
    case TuneTarget::kFailure:
      return fmt::format(
          "at most {:.3g} % of the trials fail and at most {:.3g} % are refused, except with "
          "probability {}; then the least refusal",
          100.0 * tuning.at_most, 100.0 * tuning.max_refusal, tuning.delta);
    case TuneTarget::kRisk:
      break;
  }
  return fmt::format("least {:.3g} x failure + {:.3g} x refusal", tuning.cost_of_failure,
                     tuning.cost_of_refusal);
}

}  // namespace rcme
