#include "experiments/tuning/choose_setting.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "stats/intervals.h"
#include "stats/risk_control.h"

namespace rcme {
namespace {

constexpr double kPower = 0.9;  // of the number of trials that is called enough

double RateOf(const ErrorCount& count) {
  return count.n > 0 ? static_cast<double>(count.errors) / static_cast<double>(count.n) : 1.0;
}

std::string RateInWords(const ErrorCount& count) {
  const Interval interval = ExactBinomialInterval(count.errors, count.n);
  return fmt::format("{:.3g} % [{:.3g}, {:.3g}] of {}", 100.0 * RateOf(count), 100.0 * interval.lower,
                     100.0 * interval.upper, count.n);
}

// What is to be least among the settings that meet the target.
double Objective(const Tuning& tuning, const SettingCount& count) {
  return RateOf(tuning.target == TuneTarget::kFalseRefusal ? count.Failure() : count.Refusal());
}

// The p-value of "the setting violates the target".
double PValue(const Tuning& tuning, const SettingCount& count) {
  const double p = ExcessPValue(TargetedCount(tuning, count), tuning.at_most);
  return HasRefusalLimit(tuning) ? std::max(p, ExcessPValue(count.Refusal(), tuning.max_refusal)) : p;
}

// No other setting is better in one of the two and as good in the other.
std::vector<size_t> ParetoFront(const Tuning& tuning, const std::vector<SettingCount>& counts) {
  std::vector<size_t> order(counts.size()), front;
  std::iota(order.begin(), order.end(), 0);
  const auto limited = [&](size_t s) { return RateOf(TargetedCount(tuning, counts[s])); };
  const auto objective = [&](size_t s) { return Objective(tuning, counts[s]); };
  std::ranges::sort(order, {}, [&](size_t s) { return std::tuple(limited(s), objective(s), s); });
  for (const size_t s : order) {
    const bool is_tie =
        !front.empty() && limited(s) == limited(front.back()) && objective(s) == objective(front.back());
    if (front.empty() || is_tie || objective(s) < objective(front.back())) front.push_back(s);
  }
  return front;
}

std::vector<size_t> PathOf(const Tuning& tuning, const std::vector<SettingCount>& explored) {
  std::vector<size_t> path = ParetoFront(tuning, explored);
  std::ranges::stable_sort(path, {}, [&](size_t s) { return PValue(tuning, explored[s]); });
  return path;
}

// Of the settings that keep to the limit on refusals in the exploration, the one nearest to the target; of
// all, if none does.
size_t NearestSetting(const Tuning& tuning, const std::vector<SettingCount>& explored) {
  const auto key = [&](size_t s) {
    const double excess =
        HasRefusalLimit(tuning) ? std::max(0.0, RateOf(explored[s].Refusal()) - tuning.max_refusal) : 0.0;
    return std::tuple(excess, RateOf(TargetedCount(tuning, explored[s])), Objective(tuning, explored[s]));
  };
  size_t nearest = 0;
  for (size_t s = 1; s < explored.size(); ++s) {
    if (key(s) < key(nearest)) nearest = s;
  }
  return nearest;
}

// What stands between a count and its limit: nothing, trials, or the rate itself.
std::string Obstacle(const char* what, const ErrorCount& count, double at_most, double delta) {
  if (ExcessPValue(count, at_most) <= delta) return {};
  if (count.n == 0) return fmt::format("{}: no trial is good without the quality test", what);
  const std::string figure = fmt::format("{} {}", what, RateInWords(count));
  if (ExactBinomialInterval(count.errors, count.n).lower > at_most) {
    return figure + fmt::format(": {:.3g} % is out of reach", 100.0 * at_most);
  }
  if (RateOf(count) >= at_most) {
    return figure + fmt::format(", which is not below {:.3g} %", 100.0 * at_most);
  }
  return figure +
         fmt::format(", too few trials: if that is the rate, {} certify {:.3g} % with probability {}",
                     TrialsToCertify(RateOf(count), at_most, delta, kPower), 100.0 * at_most, kPower);
}

std::string WhyNone(const Tuning& tuning, const std::vector<std::string>& settings,
                    const std::vector<SettingCount>& explored, const std::vector<SettingCount>& calibrated) {
  const size_t nearest = NearestSetting(tuning, explored);
  const bool is_failure = tuning.target == TuneTarget::kFailure;
  std::string why = Obstacle(is_failure ? "failure" : "false refusal",
                             TargetedCount(tuning, calibrated[nearest]), tuning.at_most, tuning.delta);
  const std::string refusal = HasRefusalLimit(tuning) ? Obstacle("refusal", calibrated[nearest].Refusal(),
                                                                 tuning.max_refusal, tuning.delta)
                                                      : "";
  if (!why.empty() && !refusal.empty()) why += "; ";
  why += refusal;
  if (why.empty()) why = "it is certified, but a setting tested before it was not; more trials would tell";
  return fmt::format("nearest is {}: {}; no setting is certified to meet the target ({})", settings[nearest],
                     why, TargetInWords(tuning));
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
  const double half = 0.5 * tuning.delta;  // each of the two bounds may fail
  choice.risk_bound = tuning.cost_of_failure * UpperBound(calibrated[best].Failure(), half) +
                      tuning.cost_of_refusal * UpperBound(calibrated[best].Refusal(), half);
  return choice;
}

TargetVerdict VerdictOf(const ErrorCount& count, double at_most) {
  const Interval interval = ExactBinomialInterval(count.errors, count.n);
  if (interval.upper <= at_most) return TargetVerdict::kHolds;
  return interval.lower > at_most ? TargetVerdict::kViolated : TargetVerdict::kUndecided;
}

}  // namespace

ErrorCount TargetedCount(const Tuning& tuning, const SettingCount& count) {
  return tuning.target == TuneTarget::kFalseRefusal ? count.FalseRefusal() : count.Failure();
}

bool HasRefusalLimit(const Tuning& tuning) {
  return tuning.target == TuneTarget::kFailure && tuning.max_refusal < 1.0;
}

TargetVerdict VerdictOf(const Tuning& tuning, const SettingCount& count) {
  const TargetVerdict targeted = VerdictOf(TargetedCount(tuning, count), tuning.at_most);
  if (!HasRefusalLimit(tuning)) return targeted;
  const TargetVerdict refusal = VerdictOf(count.Refusal(), tuning.max_refusal);
  if (targeted == refusal) return targeted;
  const bool is_violated = targeted == TargetVerdict::kViolated || refusal == TargetVerdict::kViolated;
  return is_violated ? TargetVerdict::kViolated : TargetVerdict::kUndecided;
}

bool ViolatesTarget(const Tuning& tuning, const SettingCount& count) {
  return RateOf(TargetedCount(tuning, count)) > tuning.at_most ||
         (HasRefusalLimit(tuning) && RateOf(count.Refusal()) > tuning.max_refusal);
}

double Risk(const Tuning& tuning, const SettingCount& count) {
  return tuning.cost_of_failure * RateOf(count.Failure()) + tuning.cost_of_refusal * RateOf(count.Refusal());
}

Choice ChooseSetting(const Tuning& tuning, const std::vector<std::string>& settings,
                     const std::vector<SettingCount>& explored, const std::vector<SettingCount>& calibrated) {
  if (tuning.target == TuneTarget::kRisk) return ChooseLeastRisk(tuning, explored, calibrated);
  Choice choice;
  choice.path = PathOf(tuning, explored);
  std::vector<double> p_values;
  for (const size_t s : choice.path) p_values.push_back(PValue(tuning, calibrated[s]));
  choice.num_certified = CountCertified(p_values, tuning.delta);
  if (choice.num_certified == 0) {
    choice.why = WhyNone(tuning, settings, explored, calibrated);
    return choice;
  }
  const auto certified = choice.path.begin() + static_cast<std::ptrdiff_t>(choice.num_certified);
  choice.setting = *std::min_element(choice.path.begin(), certified, [&](size_t a, size_t b) {
    return Objective(tuning, calibrated[a]) < Objective(tuning, calibrated[b]);
  });
  return choice;
}

std::string WhyTooFewTrials(const Tuning& tuning, std::int64_t num_trials) {
  if (tuning.target == TuneTarget::kRisk) return {};
  const double strictest =
      HasRefusalLimit(tuning) ? std::min(tuning.at_most, tuning.max_refusal) : tuning.at_most;
  const std::int64_t needed = FewestCertifyingTrials(strictest, tuning.delta);
  if (num_trials >= needed) return {};
  return fmt::format(
      "{} trials of calibration cannot certify {:.3g} % at delta {}, whatever they show: {} would do if none "
      "of "
      "them erred",
      num_trials, 100.0 * strictest, tuning.delta, needed);
}

std::string TargetInWords(const Tuning& tuning) {
  switch (tuning.target) {
    case TuneTarget::kFalseRefusal:
      return fmt::format(
          "at most {:.3g} % of the trials that would be good without the quality test are refused, except "
          "with "
          "probability {}; then the least failure",
          100.0 * tuning.at_most, tuning.delta);
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
