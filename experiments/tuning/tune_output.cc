#include "experiments/tuning/tune_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "experiments/core/table/render_table.h"
#include "experiments/core/text/columns.h"
#include "experiments/tuning/rate_output.h"
#include "stats/intervals.h"
#include "stats/thresholds.h"

namespace rcme {
namespace {

using Rows = std::vector<std::vector<std::string>>;

constexpr size_t kMaxChosenRows = 12;

bool AllDecideAlike(const std::vector<SettingCount>& counts) {
  return counts.size() > 1 &&
         std::ranges::all_of(counts, [&](const SettingCount& count) { return count == counts.front(); });
}

std::string TrialsInWords(const StudyPlan& plan) {
  const Tuning& tuning = *plan.study.tuning;
  const auto c = static_cast<std::int64_t>(plan.conditions.size());
  return fmt::format("{} conditions; {} trials to explore, {} to calibrate, {} to verify", c,
                     c * tuning.explore, c * tuning.calibrate, c * tuning.verify);
}

// Tuned, verified and the optimism of the tuned figure, rate by rate.
std::string VerifiedAsTable(const TuneResult& result) {
  const SettingCount& tuned = result.calibrated[*result.choice.setting];
  const SettingCount& verified = result.verified[*result.choice.setting];
  Rows rows = {{"rate", "verified, fresh trials", "n", "as tuned", "n", "optimism (tuned minus verified)"}};
  const auto add = [&](const std::string& name, const ErrorCount& fresh, const ErrorCount& seen) {
    rows.push_back(
        {name, RateForTable(fresh), fmt::format("{}", fresh.n), RateForTable(seen), fmt::format("{}", seen.n),
         fresh.n > 0 && seen.n > 0 ? fmt::format("{:+.2f} points", 100.0 * (RateOf(seen) - RateOf(fresh)))
                                   : "-"});
  };
  add("failure", verified.Failure(), tuned.Failure());
  add("refusal", verified.Refusal(), tuned.Refusal());
  add("false refusal", verified.FalseRefusal(), tuned.FalseRefusal());
  return FormatColumns(rows);
}

std::string EstimatorsAsTable(const std::vector<VerifiedEstimator>& estimators) {
  Rows rows = {{"estimator", "failure", "refusal", "failure or refusal", "tuned minus this", "p (McNemar)"}};
  for (size_t e = 0; e < estimators.size(); ++e) {
    const VerifiedEstimator& counts = estimators[e];
    const Interval difference = RiskDifferenceInterval(counts.against_first);
    rows.push_back(
        {e == 0 ? "tuned" : counts.spec.label, RateForTable(counts.failure), RateForTable(counts.refusal),
         RateForTable(counts.failure_or_refusal),
         e == 0 ? ""
                : FormatEstimate({counts.against_first.RiskDifference(), difference}, {100.0, "%", "+.2f"}),
         e == 0 ? "" : fmt::format("{:.2g}", McNemarExactPValue(counts.against_first))});
  }
  return FormatColumns(rows);
}

std::string RocsAsTable(const StudyPlan& plan, const std::vector<EntropyRoc>& rocs) {
  Rows rows = {{"estimator", "models", "area under the curve", "good", "bad"}};
  for (const EntropyRoc& roc : rocs) {
    rows.push_back({plan.study.estimators[roc.estimator].label, roc.population,
                    FormatEstimate({roc.area.value, roc.area.interval}, {1.0, "", ".3f"}),
                    fmt::format("{}", roc.good.size()), fmt::format("{}", roc.bad.size())});
  }
  return FormatColumns(rows);
}

std::string CertifiedInWords(const Tuning& tuning, const Choice& choice) {
  if (tuning.target == TuneTarget::kRisk) return " (the least in the exploration; nothing is certified)";
  return fmt::format(" ({} of {} settings in the order of testing certified)", choice.num_certified,
                     choice.path.size());
}

// Whether the tuned setting met the limits of its target on fresh trials.
std::string VerdictInWords(const Tuning& tuning, const TuneResult& result) {
  const SettingCount& verified = result.verified[*result.choice.setting];
  if (tuning.target == TuneTarget::kRisk) {
    return fmt::format("verified risk {:.4g}; bound {:.4g}, exceeded with probability {} at most",
                       Risk(tuning, verified), result.choice.risk_bound, tuning.delta);
  }
  switch (VerdictOf(tuning, verified)) {
    case Verdict::kHolds:
      return "on fresh trials the target holds (95 % intervals)";
    case Verdict::kDoesNotHold:
      return "on fresh trials the target is VIOLATED (95 % intervals)";
    case Verdict::kUndecided:
      break;
  }
  return "on fresh trials too few to decide whether the target holds (95 % intervals)";
}

// The settings that were chosen at all, the most frequent first.
std::vector<size_t> ByTimesChosen(const Repetitions& repetitions) {
  std::vector<size_t> chosen;
  for (size_t s = 0; s < repetitions.num_chosen.size(); ++s) {
    if (repetitions.num_chosen[s] > 0) chosen.push_back(s);
  }
  std::ranges::stable_sort(chosen, std::greater<>(), [&](size_t s) { return repetitions.num_chosen[s]; });
  return chosen;
}

// The first rows of `chosen`, and every setting whose target is not known to hold.
std::string ChosenAsTable(const Tuning& tuning, const SettingPlan& settings, const Repetitions& repetitions,
                          const std::vector<size_t>& chosen) {
  const std::vector<std::string> names = SettingsInWords(tuning, settings);
  Rows rows = {{"chosen", "times", "failure", "refusal", "false refusal", "target"}};
  for (size_t i = 0; i < chosen.size(); ++i) {
    const size_t s = chosen[i];
    const SettingCount& count = repetitions.reference[s];
    const Verdict verdict = VerdictOf(tuning, count);
    if (i >= kMaxChosenRows && verdict == Verdict::kHolds) continue;
    rows.push_back({names[s], fmt::format("{}", repetitions.num_chosen[s]), RateForTable(count.Failure()),
                    RateForTable(count.Refusal()), RateForTable(count.FalseRefusal()), Name(verdict)});
  }
  return FormatColumns(rows);
}

}  // namespace

std::string TuneAsTable(const StudyPlan& plan, const TuneResult& result,
                        const std::vector<EntropyRoc>& rocs) {
  const Tuning& tuning = *plan.study.tuning;
  std::string text =
      fmt::format("{}: {} settings of {}, {}\nTarget: {}\n", plan.study.name, result.settings.size(),
                  tuning.estimator, TrialsInWords(plan), TargetInWords(tuning));
  if (!result.choice.setting) return text + fmt::format("Not reached: {}\n", result.choice.why);
  text += fmt::format(
      "Tuned: {}{}; {}\n\n{}\n"
      "On the trials for verification, all with the same problems (exact 95 % intervals; differences: "
      "Tango)\n\n{}",
      result.settings[*result.choice.setting], CertifiedInWords(tuning, result.choice),
      VerdictInWords(tuning, result), VerifiedAsTable(result), EstimatorsAsTable(result.estimators));
  if (AllDecideAlike(result.verified)) {
    text += "\nAll settings decided alike: the options that were tuned had no effect on these trials.\n";
  }
  if (rocs.empty()) return text;
  return text +
         fmt::format("\nDoes psi tell good models from bad ones? (1: always, 0.5: chance; DeLong 95 %)\n\n{}",
                     RocsAsTable(plan, rocs));
}

std::string RepetitionsAsTable(const StudyPlan& plan, const SettingPlan& settings,
                               const Repetitions& repetitions) {
  const Tuning& tuning = *plan.study.tuning;
  const auto num_conditions = static_cast<std::int64_t>(plan.conditions.size());
  const ErrorCount violated{repetitions.num_violated, repetitions.num_done};
  const ErrorCount not_shown{violated.errors + repetitions.num_undecided, violated.n};
  const std::vector<size_t> chosen = ByTimesChosen(repetitions);
  std::string text = fmt::format(
      "{}: tuned {} times with fresh seeds ({} trials to explore, {} to calibrate each)\nTarget: {}\n"
      "Violated: {} of {}: {}; violated or undecided: {}: {}; promised at most {:.3g} %; without a choice: "
      "{}\n\n"
      "What was chosen, on {} further trials (all 95 % intervals below the limits: holds)\n\n{}",
      plan.study.name, repetitions.num_done, tuning.explore * num_conditions,
      tuning.calibrate * num_conditions, TargetInWords(tuning), violated.errors, violated.n,
      RateForTable(violated), not_shown.errors, RateForTable(not_shown), 100.0 * tuning.delta,
      repetitions.num_without_choice, repetitions.reference.front().n,
      ChosenAsTable(tuning, settings, repetitions, chosen));
  if (chosen.size() > kMaxChosenRows) {
    text += fmt::format(
        "{} settings were chosen in all; shown are the {} most frequent, and all that are not shown to "
        "hold\n",
        chosen.size(), kMaxChosenRows);
  }
  return text;
}

std::vector<std::pair<std::string, std::string>> ProvenanceOf(const StudyPlan& plan,
                                                              const TuneResult& result) {
  const Tuning& tuning = *plan.study.tuning;
  const size_t s = result.choice.setting.value();
  const auto rates = [](const SettingCount& count) {
    return fmt::format("failure {} of {}, refusal {}, false refusal {} of {}", RateForTable(count.Failure()),
                       count.n, RateForTable(count.Refusal()), RateForTable(count.FalseRefusal()),
                       count.good);
  };
  return {{"study", plan.study.name},
          {"seed", fmt::format("{}", plan.study.seed)},
          {"estimator", tuning.estimator},
          {"tuned", result.settings[s]},
          {"target", TargetInWords(tuning)},
          {"failure", fmt::format("rotation error above {} deg or direction error above {} deg",
                                  plan.study.failure.max_rotation_error_deg,
                                  plan.study.failure.max_direction_error_deg)},
          {"trials", TrialsInWords(plan)},
          {"as_tuned", rates(result.calibrated[s])},
          {"verified", rates(result.verified[s])},
          {"verdict", VerdictInWords(tuning, result)},
          {"program", "rcme " RCME_VERSION}};
}

}  // namespace rcme
