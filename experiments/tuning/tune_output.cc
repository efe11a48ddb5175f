#include "experiments/tuning/tune_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "estimator/estimator_registry.h"
#include "estimator/ransac_estimator.h"
#include "experiments/base/columns.h"
#include "experiments/base/field_text.h"
#include "experiments/base/file_output.h"
#include "experiments/base/json_output.h"
#include "experiments/study/tuning_file.h"
#include "stats/intervals.h"
#include "stats/pareto_front.h"
#include "stats/thresholds.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;
using Rows = std::vector<std::vector<std::string>>;

constexpr size_t kMaxCurvePoints = 300;
constexpr size_t kMaxChosenRows = 12;

double RateOf(const ErrorCount& count) {
  return static_cast<double>(count.errors) / static_cast<double>(count.n);
}

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
                : fmt::format("{:+.2f} % [{:+.2f}, {:+.2f}]", 100.0 * counts.against_first.RiskDifference(),
                              100.0 * difference.lower, 100.0 * difference.upper),
         e == 0 ? "" : fmt::format("{:.2g}", McNemarExactPValue(counts.against_first))});
  }
  return FormatColumns(rows);
}

std::string RocsAsTable(const StudyPlan& plan, const std::vector<EntropyRoc>& rocs) {
  Rows rows = {{"estimator", "models", "area under the curve", "good", "bad"}};
  for (const EntropyRoc& roc : rocs) {
    rows.push_back({plan.study.estimators[roc.estimator].label, roc.population,
                    fmt::format("{:.3f} [{:.3f}, {:.3f}]", roc.area.value, roc.area.interval.lower,
                                roc.area.interval.upper),
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

Json EstimatorAsJson(const VerifiedEstimator& counts) {
  return {{"failure", RateAsJson(counts.failure)},
          {"refusal", RateAsJson(counts.refusal)},
          {"failure_or_refusal", RateAsJson(counts.failure_or_refusal)}};
}

bool IsNumber(const std::string& text) {
  double number = 0.0;
  return ParseReal(text, &number);
}

// The options, a number in place of a word where the word stands for one.
Settings InNumbers(EstimatorSpec spec) {
  const std::unique_ptr<MotionEstimator> estimator = Make(spec);
  if (const RansacEstimator* ransac = AsRansac(*estimator)) {
    for (auto& [option, value] : spec.options) {
      if (option == "mu") value = fmt::format("{}", ransac->options().MuOrDefault());
      if (option == "sample_significance_level")
        value = fmt::format("{}", ransac->options().SampleLevelOrDefault());
    }
  }
  return spec.options;
}

// The levels of the tuned options at which another estimator is the tuned one; null if it differs in more, or
// has a word ("auto") where the levels are numbers.
Json LevelsOf(const Tuning& tuning, const EstimatorSpec& tuned, const EstimatorSpec& other) {
  if (tuned.name != other.name) return nullptr;
  const Settings tuned_options = InNumbers(tuned), other_options = InNumbers(other);
  Settings levels;
  for (size_t i = 0; i < tuned_options.size(); ++i) {
    const auto& [option, level] = other_options[i];
    const auto is_tuned = std::ranges::find(tuning.options, option, &TunedOption::name);
    if (is_tuned == tuning.options.end()) {
      if (tuned_options[i] != other_options[i]) return nullptr;
      continue;
    }
    if (std::ranges::all_of(is_tuned->levels, IsNumber) && !IsNumber(level)) return nullptr;
    levels.emplace_back(option, level);
  }
  Json in_order = Json::array();
  for (const TunedOption& option : tuning.options) {
    in_order.push_back(std::ranges::find(levels, option.name, &Settings::value_type::first)->second);
  }
  return in_order;
}

Json OthersAsJson(const Tuning& tuning, const std::vector<VerifiedEstimator>& estimators) {
  Json others = Json::array();
  for (size_t e = 1; e < estimators.size(); ++e) {
    Json other = {{"label", estimators[e].spec.label},
                  {"words", "as in the study"},
                  {"levels", LevelsOf(tuning, estimators.front().spec, estimators[e].spec)}};
    other.update(EstimatorAsJson(estimators[e]));
    others.push_back(std::move(other));
  }
  return others;
}

// Accepted is what has psi at most mu. A good model is a positive, and the lower its psi the higher its
// score.
std::vector<RocPoint> CurveOf(const EntropyRoc& roc) {
  const auto scores = [](std::vector<double> psi) {
    for (double& x : psi) x = -x;
    return psi;
  };
  return RocCurve(scores(roc.bad), scores(roc.good));
}

// The point of the curve at a threshold mu.
RocPoint PointAt(const std::vector<RocPoint>& curve, double mu) {
  RocPoint point = curve.front();
  for (const RocPoint& next : curve) {
    if (next.threshold >= -mu) point = next;
  }
  return point;
}

// [mu, share of the bad ones accepted, share of the good ones accepted] of some points, ends included.
Json CurveAsJson(const std::vector<RocPoint>& curve) {
  Json points = Json::array({Json::array({nullptr, 0.0, 0.0})});
  const size_t step = 1 + curve.size() / kMaxCurvePoints;
  for (size_t i = 1; i < curve.size(); i += step) {
    points.push_back({-curve[i].threshold, curve[i].false_positive_rate, curve[i].true_positive_rate});
  }
  points.push_back({nullptr, 1.0, 1.0});
  return points;
}

Json RocAsJson(const StudyPlan& plan, const EntropyRoc& roc) {
  const EstimatorSpec& spec = plan.study.estimators[roc.estimator];
  const RansacOptions& options = AsRansac(*plan.estimators[roc.estimator])->options();
  const double mu = options.MuOrDefault();
  const bool is_printed = options.reading == Reading::kAsPrinted;
  const std::vector<RocPoint> curve = CurveOf(roc);
  const RocPoint at_mu = PointAt(curve, mu);
  return {
      {"estimator", spec.label},
      {"population", roc.population},
      {"score", is_printed ? "psi, nats" : "excess entropy, nats"},
      {"auc",
       {{"value", roc.area.value}, {"lower", roc.area.interval.lower}, {"upper", roc.area.interval.upper}}},
      {"num_good", roc.good.size()},
      {"num_bad", roc.bad.size()},
      {"curve", CurveAsJson(curve)},
      {"marks", Json::array({{{"words", fmt::format("mu = {}", mu)},
                              {"false_accept_rate", at_mu.false_positive_rate},
                              {"true_accept_rate", at_mu.true_positive_rate}}})}};
}

// Per setting, whether it is on the Pareto front: none fails and is refused as seldom, and one of the two
// less often.
std::vector<bool> AreOnFront(const std::vector<SettingCount>& counts) {
  std::vector<double> refusals, failures;
  for (const SettingCount& count : counts) {
    refusals.push_back(static_cast<double>(count.refusals));
    failures.push_back(static_cast<double>(count.failures));
  }
  std::vector<bool> are_on_front(counts.size());
  for (const size_t s : ParetoFront(refusals, failures, TiesOfFirst::kLeastSecondStays))
    are_on_front[s] = true;
  return are_on_front;
}

Json SettingsAsJson(const SettingPlan& settings, const TuneResult& result) {
  const std::vector<bool> are_on_front = AreOnFront(result.verified);
  Json all = Json::array();
  const std::vector<size_t>& path = result.choice.path;
  for (size_t s = 0; s < settings.settings.size(); ++s) {
    const auto place = std::ranges::find(path, s);
    all.push_back(
        {{"levels", settings.settings[s].levels},
         {"failure", RateAsJson(result.verified[s].Failure())},
         {"refusal", RateAsJson(result.verified[s].Refusal())},
         {"false_refusal", RateAsJson(result.verified[s].FalseRefusal())},
         {"is_on_front", static_cast<bool>(are_on_front[s])},
         {"is_on_path", place != path.end()},
         {"is_certified", place - path.begin() < static_cast<std::ptrdiff_t>(result.choice.num_certified)}});
  }
  return all;
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

Json RateAsJson(const ErrorCount& count) {
  const Interval interval = ExactBinomialInterval(count.errors, count.n);
  return {{"value", count.n > 0 ? Json(RateOf(count)) : Json(nullptr)},
          {"lower", interval.lower},
          {"upper", interval.upper},
          {"n", count.n}};
}

std::string RateForTable(const ErrorCount& count) {
  if (count.n == 0) return "-";
  const Interval interval = ExactBinomialInterval(count.errors, count.n);
  return fmt::format("{:.2f} % [{:.2f}, {:.2f}]", 100.0 * RateOf(count), 100.0 * interval.lower,
                     100.0 * interval.upper);
}

Json TargetAsJson(const Tuning& tuning) {
  Tuning copy = tuning;
  const bool is_risk = tuning.target == TuneTarget::kRisk, is_failure = LimitsFailures(tuning.target);
  return {{"kind", FindParameter(Parameters(copy), "target").Value()},
          {"at_most", is_risk ? Json(nullptr) : Json(tuning.at_most)},
          {"max_refusal", is_failure ? Json(tuning.max_refusal) : Json(nullptr)},
          {"delta", tuning.delta},
          {"words", TargetInWords(tuning)}};
}

Json OptionsAsJson(const Study& study) {
  const EstimatorSpec& spec = TunedEstimator(*study.tuning, study.estimators);
  const std::unique_ptr<EstimatorModel> model = Configure(spec);
  const std::vector<Parameter> parameters = model->Parameters();
  Json options = Json::array();
  for (const TunedOption& option : study.tuning->options) {
    options.push_back({{"name", option.name},
                       {"unit", FindOption(spec.name, parameters, option.name).unit()},
                       {"levels", option.levels}});
  }
  return options;
}

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

std::string TuneAsJson(const StudyPlan& plan, const SettingPlan& settings, const TuneResult& result,
                       const std::vector<EntropyRoc>& rocs) {
  const Tuning& tuning = *plan.study.tuning;
  Json json = {{"study", plan.study.name},
               {"estimator", tuning.estimator},
               {"seed", plan.study.seed},
               {"target", TargetAsJson(tuning)},
               {"options", OptionsAsJson(plan.study)},
               {"settings", SettingsAsJson(settings, result)},
               {"tuned", nullptr},
               {"others", Json::array()},
               {"roc", Json::array()}};
  if (result.choice.setting) {
    const size_t s = *result.choice.setting;
    json["tuned"] = EstimatorAsJson(result.estimators.front());
    json["tuned"]["levels"] = settings.settings[s].levels;
    json["tuned"]["false_refusal"] = RateAsJson(result.verified[s].FalseRefusal());
    json["others"] = OthersAsJson(tuning, result.estimators);
  }
  for (const EntropyRoc& roc : rocs) json["roc"].push_back(RocAsJson(plan, roc));
  return JsonText(kTuningFormat, json);
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
