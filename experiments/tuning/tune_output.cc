#include "experiments/tuning/tune_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>

#include "experiments/core/table/render_table.h"
#include "experiments/core/text/json_output.h"
#include "experiments/trial/simulate_draw.h"
#include "stats/intervals.h"

namespace rcme {
namespace {

constexpr size_t kMaxChosenRows = 12;

bool AllDecideAlike(const std::vector<SettingCount>& counts) {
  return counts.size() > 1 &&
         std::ranges::all_of(counts, [&](const SettingCount& count) { return count == counts.front(); });
}

std::string DescribeTrials(const StudyPlan& plan) {
  const Tuning& tuning = *plan.study.tuning;
  const auto c = static_cast<std::int64_t>(plan.conditions.size());
  return fmt::format("{} conditions; {} trials to explore, {} to calibrate, {} to verify", c,
                     c * tuning.explore, c * tuning.calibrate, c * tuning.verify);
}

// How many of all trials of the tuning could not be simulated.
std::string DescribeMissingTuningTrials(const StudyPlan& plan, const TuneResult& result) {
  const Tuning& tuning = *plan.study.tuning;
  std::int64_t num_trials = 0, num_simulated = 0;
  const auto add = [&](const std::vector<SettingCount>& counts, int per_condition) {
    if (counts.empty()) return;
    num_trials += per_condition * std::ssize(plan.conditions);
    num_simulated += counts.front().n;
  };
  add(result.explored, tuning.explore);
  add(result.calibrated, tuning.calibrate);
  add(result.verified, tuning.verify);
  return FormatParagraph(DescribeNotSimulated(num_trials - num_simulated, num_trials));
}

// For each rate: the tuned figure, the verified one, and the optimism of the former.
Table MakeVerifiedTable(const Tuning& tuning, const TuneResult& result) {
  const SettingCount& tuned = result.calibrated[*result.choice.setting];
  const SettingCount& verified = result.verified[*result.choice.setting];
  Table table{{Column::Key("rate"), Column::Estimated("verified, fresh trials", kPercent), Column::Count("n"),
               Column::Estimated("as tuned", kPercent), Column::Count("n"),
               Column::Number("optimism (tuned minus verified, % points)", {100.0, "", "+.2f"})}};
  const auto add = [&](const char* name, const ErrorCount& fresh, const ErrorCount& seen) {
    table.rows.push_back({name, EstimateRate(fresh), fresh.n, EstimateRate(seen), seen.n,
                          ComputeRate(seen) - ComputeRate(fresh)});
  };
  add("failure", verified.Failure(), tuned.Failure());
  if (tuning.target == TuneTarget::kAcceptedFailure)
    add("accepted failure", verified.AcceptedFailure(), tuned.AcceptedFailure());
  add("refusal", verified.Refusal(), tuned.Refusal());
  add("false refusal", verified.FalseRefusal(), tuned.FalseRefusal());
  return table;
}

// The first of the estimators is the tuned one.
Table MakeEstimatorTable(const std::vector<VerifiedEstimator>& estimators) {
  Table table{{Column::Key("estimator"), Column::Estimated("failure", kPercent),
               Column::Estimated("refusal", kPercent), Column::Estimated("failure or refusal", kPercent),
               Column::Estimated("tuned minus this", {100.0, "%", "+.2f"}),
               Column::Number("p (McNemar)", {1.0, "", ".2g"})}};
  for (const VerifiedEstimator& counts : estimators) {
    const bool is_first = table.rows.empty();
    table.rows.push_back({is_first ? "tuned" : counts.spec.label, EstimateRate(counts.failure),
                          EstimateRate(counts.refusal), EstimateRate(counts.failure_or_refusal)});
    const PairedCounts& paired = counts.against_first;
    if (is_first) {
      table.rows.back().resize(table.columns.size());
    } else {
      table.rows.back().emplace_back(Estimate{paired.RiskDifference(), RiskDifferenceInterval(paired)});
      table.rows.back().emplace_back(McNemarExactPValue(paired));
    }
  }
  return table;
}

Table MakeRocTable(const StudyPlan& plan, const std::vector<EntropyRoc>& rocs) {
  using R = const EntropyRoc&;
  return MakeTable<EntropyRoc>(
      {{Column::Key("estimator"), [&](R r) { return plan.study.estimators[r.estimator].label; }},
       {Column::Key("models"), [](R r) { return r.population; }},
       {Column::Estimated("area under the curve", {1.0, "", ".3f"}),
        [](R r) {
          return Estimate{r.area.value, r.area.interval};
        }},
       {Column::Count("good"), [](R r) { return std::ssize(r.good); }},
       {Column::Count("bad"), [](R r) { return std::ssize(r.bad); }}},
      rocs);
}

std::string DescribeCertified(const Tuning& tuning, const Choice& choice) {
  if (tuning.target == TuneTarget::kRisk) return " (the least in the exploration; nothing is certified)";
  return fmt::format(" ({} of {} settings in the order of testing certified)", choice.num_certified,
                     choice.path.size());
}

// Whether the tuned setting met the limits of its target on fresh trials.
std::string DescribeVerdict(const Tuning& tuning, const TuneResult& result) {
  const SettingCount& verified = result.verified[*result.choice.setting];
  if (tuning.target == TuneTarget::kRisk) {
    return fmt::format("verified risk {:.4g}; bound {:.4g}, exceeded with probability {} at most",
                       Risk(tuning, verified), result.choice.risk_bound, tuning.delta);
  }
  switch (DecideSetting(tuning, verified)) {
    case Verdict::kHolds:
      return "on fresh trials the target holds (95 % intervals)";
    case Verdict::kDoesNotHold:
      return "on fresh trials the target is VIOLATED (95 % intervals)";
    case Verdict::kUndecided:
      break;
  }
  return "on fresh trials too few to decide whether the target holds (95 % intervals)";
}

// The settings that were chosen at least once, the most frequent first.
std::vector<size_t> ByTimesChosen(const Repetitions& repetitions) {
  std::vector<size_t> chosen;
  for (size_t s = 0; s < repetitions.num_chosen.size(); ++s) {
    if (repetitions.num_chosen[s] > 0) chosen.push_back(s);
  }
  std::ranges::stable_sort(chosen, std::greater<>(), [&](size_t s) { return repetitions.num_chosen[s]; });
  return chosen;
}

// The first rows of `chosen`, and every setting for which the target is not known to hold.
Table MakeChosenTable(const Tuning& tuning, const SettingPlan& settings, const Repetitions& repetitions,
                      const std::vector<size_t>& chosen) {
  const std::vector<std::string> names = DescribeEachSetting(tuning, settings);
  Table table{{Column::Key("chosen"), Column::Count("times"), Column::Estimated("failure", kPercent),
               Column::Estimated("refusal", kPercent), Column::Estimated("false refusal", kPercent),
               Column::Text("target")}};
  for (size_t i = 0; i < chosen.size(); ++i) {
    const size_t s = chosen[i];
    const SettingCount& count = repetitions.reference[s];
    const Verdict verdict = DecideSetting(tuning, count);
    if (i >= kMaxChosenRows && verdict == Verdict::kHolds) continue;
    table.rows.push_back({names[s], repetitions.num_chosen[s], EstimateRate(count.Failure()),
                          EstimateRate(count.Refusal()), EstimateRate(count.FalseRefusal()), Name(verdict)});
  }
  return table;
}

}  // namespace

double ComputeRate(const ErrorCount& count) {
  return static_cast<double>(count.errors) / static_cast<double>(count.n);
}

Estimate EstimateRate(const ErrorCount& count) {
  return {ComputeRate(count), ExactBinomialInterval(count.errors, count.n)};
}

std::string RateForTable(const ErrorCount& count) { return FormatEstimate(EstimateRate(count), kPercent); }

nlohmann::ordered_json RateAsJson(const ErrorCount& count) {
  nlohmann::ordered_json json = RenderJsonBounds(EstimateRate(count));
  json["n"] = count.n;
  return json;
}

std::string TuneAsTable(const StudyPlan& plan, const TuneResult& result,
                        const std::vector<EntropyRoc>& rocs) {
  const Tuning& tuning = *plan.study.tuning;
  std::string text =
      FormatParagraph(fmt::format("{}: {} settings of {}, {}", plan.study.name, result.settings.size(),
                                  tuning.estimator, DescribeTrials(plan))) +
      FormatParagraph("Target: " + DescribeTarget(tuning)) + DescribeMissingTuningTrials(plan, result);
  if (!result.choice.setting) return text + FormatParagraph("Not reached: " + result.choice.why);
  text +=
      FormatParagraph(fmt::format("Tuned: {}{}; {}", result.settings[*result.choice.setting],
                                  DescribeCertified(tuning, result.choice),
                                  DescribeVerdict(tuning, result))) +
      "\n" + RenderText(MakeVerifiedTable(*plan.study.tuning, result)) + "\n" +
      FormatParagraph(
          "On the trials for verification, all with the same problems (exact 95 % intervals; differences: "
          "Tango)") +
      "\n" + RenderText(MakeEstimatorTable(result.estimators));
  if (AllDecideAlike(result.verified)) {
    text +=
        "\n" + FormatParagraph(
                   "All settings decided alike: the options that were tuned had no effect on these trials.");
  }
  if (rocs.empty()) return text;
  return text + "\nDoes psi tell good models from bad ones? (1: always, 0.5: chance; DeLong 95 %)\n\n" +
         RenderText(MakeRocTable(plan, rocs));
}

Table MakeSettingTable(const StudyPlan& plan, const SettingPlan& settings, const TuneResult& result) {
  const std::vector<size_t>& path = result.choice.path;
  Table table;
  for (const TunedOption& option : plan.study.tuning->options)
    table.columns.push_back({.name = option.name, .group = "levels", .is_key = true});
  for (const char* rate : {"failure", "refusal", "false_refusal"}) {
    table.columns.push_back(Column::Estimated(rate));
    table.columns.push_back(Column::Count(std::string(rate) + "_n"));
  }
  table.AddColumns({Column::Flag("is_on_path"), Column::Flag("is_certified"), Column::Flag("is_chosen")});
  for (size_t s = 0; s < result.verified.size(); ++s) {
    const auto place = std::ranges::find(path, s);
    const std::vector<std::string>& levels = settings.settings[s].levels;
    std::vector<Value>& row = table.rows.emplace_back(levels.begin(), levels.end());
    for (const ErrorCount& of :
         {result.verified[s].Failure(), result.verified[s].Refusal(), result.verified[s].FalseRefusal()})
      row.insert(row.end(), {EstimateRate(of), of.n});
    row.insert(row.end(), {place != path.end(),
                           place - path.begin() < static_cast<std::ptrdiff_t>(result.choice.num_certified),
                           result.choice.setting == s});
  }
  return WithIntervalColumns(table);
}

std::string RepetitionsAsTable(const StudyPlan& plan, const SettingPlan& settings,
                               const Repetitions& repetitions) {
  const Tuning& tuning = *plan.study.tuning;
  const auto num_conditions = static_cast<std::int64_t>(plan.conditions.size());
  const ErrorCount violated{repetitions.num_violated, repetitions.num_done};
  const ErrorCount not_shown{violated.errors + repetitions.num_undecided, violated.n};
  const std::vector<size_t> chosen = ByTimesChosen(repetitions);
  const std::int64_t num_reference = repetitions.reference.front().n;
  std::string text =
      FormatParagraph(fmt::format(
          "{}: tuned {} times with fresh seeds ({} trials to explore, {} to calibrate each)", plan.study.name,
          repetitions.num_done, tuning.explore * num_conditions, tuning.calibrate * num_conditions)) +
      FormatParagraph("Target: " + DescribeTarget(tuning)) +
      FormatParagraph(fmt::format("Violated: {} of {}: {}; promised at most {:.3g} %", violated.errors,
                                  violated.n, RateForTable(violated), 100.0 * tuning.delta)) +
      FormatParagraph(fmt::format("Violated or undecided: {}: {}; without a choice: {}", not_shown.errors,
                                  RateForTable(not_shown), repetitions.num_without_choice)) +
      "\n" +
      FormatParagraph(
          fmt::format("What was chosen, on {} further trials (all 95 % intervals below the limits: holds)",
                      num_reference)) +
      FormatParagraph(DescribeNotSimulated(tuning.verify * num_conditions - num_reference,
                                           tuning.verify * num_conditions)) +
      "\n" + RenderText(MakeChosenTable(tuning, settings, repetitions, chosen));
  if (chosen.size() > kMaxChosenRows) {
    text += FormatParagraph(fmt::format(
        "{} settings were chosen in all; shown are the {} most frequent, and all that are not shown to hold",
        chosen.size(), kMaxChosenRows));
  }
  return text;
}

std::vector<std::pair<std::string, std::string>> DescribeProvenance(const StudyPlan& plan,
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
          {"target", DescribeTarget(tuning)},
          {"failure", fmt::format("rotation error above {} deg or direction error above {} deg",
                                  plan.study.failure.max_rotation_error_deg,
                                  plan.study.failure.max_direction_error_deg)},
          {"trials", DescribeTrials(plan)},
          {"as_tuned", rates(result.calibrated[s])},
          {"verified", rates(result.verified[s])},
          {"verdict", DescribeVerdict(tuning, result)},
          {"program", "rcme " RCME_VERSION}};
}

CommandResult MakeRepetitionsResult(const StudyPlan& plan, const SettingPlan& settings,
                                    const Repetitions& repetitions) {
  Table chosen = MakeChosenTable(*plan.study.tuning, settings, repetitions, ByTimesChosen(repetitions));
  for (Column& column : chosen.columns) std::ranges::replace(column.name, ' ', '_');
  return MakeResult(RepetitionsAsTable(plan, settings, repetitions), kRepetitionsFormat,
                    {{"study", plan.study.name},
                     {"repetitions", repetitions.num_done},
                     {"without_choice", repetitions.num_without_choice},
                     {"violated", repetitions.num_violated},
                     {"undecided", repetitions.num_undecided},
                     {"promised", plan.study.tuning->delta}},
                    WithIntervalColumns(chosen));
}

}  // namespace rcme
