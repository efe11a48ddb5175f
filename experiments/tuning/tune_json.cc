#include "experiments/tuning/tune_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "estimator/estimator_registry.h"
#include "estimator/loop_inspection.h"
#include "experiments/core/table/render_table.h"
#include "experiments/core/text/json_output.h"
#include "experiments/study/tuning_file.h"
#include "experiments/tuning/tune_output.h"
#include "parameters/settings.h"
#include "stats/pareto_front.h"
#include "stats/thresholds.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kMaxCurvePoints = 300;

Json EstimatorAsJson(const VerifiedEstimator& counts) {
  return {{"failure", RateAsJson(counts.failure)},
          {"refusal", RateAsJson(counts.refusal)},
          {"failure_or_refusal", RateAsJson(counts.failure_or_refusal)}};
}

bool IsNumber(const std::string& text) {
  double number = 0.0;
  return ParseReal(text, &number);
}

// The options. A word that stands for a number is replaced by it.
Settings InNumbers(EstimatorSpec spec) {
  const std::unique_ptr<MotionEstimator> estimator = Make(spec);
  if (const LoopInspection* ransac = FindInspection(*estimator)) {
    for (auto& [option, value] : spec.options) {
      if (option == "mu") value = fmt::format("{}", ransac->options().MuOrDefault());
      if (option == "sample_significance_level")
        value = fmt::format("{}", ransac->options().SampleLevelOrDefault());
    }
  }
  return spec.options;
}

// The levels of the tuned options at which another estimator equals the tuned one. Null if it differs in
// other options, or has a word ("auto") where the levels are numbers.
Json RenderTunedLevels(const Tuning& tuning, const EstimatorSpec& tuned, const EstimatorSpec& other) {
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
  for (const TunedOption& option : tuning.options)
    in_order.push_back(FindSetting(levels, option.name).value());
  return in_order;
}

Json OthersAsJson(const Tuning& tuning, const std::vector<VerifiedEstimator>& estimators) {
  Json others = Json::array();
  for (size_t e = 1; e < estimators.size(); ++e) {
    Json other = {{"label", estimators[e].spec.label},
                  {"words", "as in the study"},
                  {"levels", RenderTunedLevels(tuning, estimators.front().spec, estimators[e].spec)}};
    other.update(EstimatorAsJson(estimators[e]));
    others.push_back(std::move(other));
  }
  return others;
}

// A model is accepted if its psi is at most mu. A good model is a positive; a lower psi is a higher score.
std::vector<RocPoint> ComputeEntropyCurve(const EntropyRoc& roc) {
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
  const RansacOptions& options = FindInspection(*plan.estimators[roc.estimator])->options();
  const double mu = options.MuOrDefault();
  const bool is_printed = options.reading == Reading::kAsPrinted;
  const std::vector<RocPoint> curve = ComputeEntropyCurve(roc);
  const RocPoint at_mu = PointAt(curve, mu);
  return {{"estimator", spec.label},
          {"population", roc.population},
          {"score", is_printed ? "psi, nats" : "excess entropy, nats"},
          {"auc", RenderJsonBounds({roc.area.value, roc.area.interval})},
          {"num_good", roc.good.size()},
          {"num_bad", roc.bad.size()},
          {"curve", CurveAsJson(curve)},
          {"marks", Json::array({{{"words", fmt::format("mu = {}", mu)},
                                  {"false_accept_rate", at_mu.false_positive_rate},
                                  {"true_accept_rate", at_mu.true_positive_rate}}})}};
}

// For each setting, whether it is on the Pareto front: no other setting has lower or equal rates of failure
// and refusal, one of them lower.
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

}  // namespace

Json TargetAsJson(const Tuning& tuning) {
  Tuning copy = tuning;
  const bool is_risk = tuning.target == TuneTarget::kRisk, is_failure = LimitsFailures(tuning.target);
  return {{"kind", FindParameter(Parameters(copy), "target").Value()},
          {"at_most", is_risk ? Json(nullptr) : Json(tuning.at_most)},
          {"max_refusal", is_failure ? Json(tuning.max_refusal) : Json(nullptr)},
          {"delta", tuning.delta},
          {"words", DescribeTarget(tuning)}};
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

std::string TuneAsJson(const StudyPlan& plan, const SettingPlan& settings, const TuneResult& result,
                       const std::vector<EntropyRoc>& rocs) {
  const Tuning& tuning = *plan.study.tuning;
  Json json = {{"study", plan.study.name},
               {"estimator", tuning.estimator},
               {"seed", plan.study.seed},
               {"target", TargetAsJson(tuning)},
               {"options", OptionsAsJson(plan.study)},
               {"rows", RenderJson(MakeSettingTable(plan, settings, result))},
               {"settings", result.verified.empty() ? Json::array() : SettingsAsJson(settings, result)},
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

}  // namespace rcme
