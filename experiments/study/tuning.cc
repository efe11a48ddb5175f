#include "experiments/study/tuning.h"

namespace rcme {

bool LimitsFailures(TuneTarget target) {
  return target == TuneTarget::kFailure || target == TuneTarget::kAcceptedFailure;
}

std::vector<Parameter> Parameters(Tuning& t) {
  const std::string per_condition = "trials per condition ";
  return {
      Parameter::Text("estimator", &t.estimator, "a label of the study", "the estimator to tune"),
      Parameter::Choice<TuneTarget>("target", &t.target,
                                    {{"false_refusal", TuneTarget::kFalseRefusal},
                                     {"failure", TuneTarget::kFailure},
                                     {"accepted_failure", TuneTarget::kAcceptedFailure},
                                     {"risk", TuneTarget::kRisk}},
                                    "what the tuned setting has to limit"),
      Parameter::Real("at_most", &t.at_most, {1e-6, 0.999}, "",
                      "greatest rate of false refusals or failures"),
      Parameter::Real("max_refusal", &t.max_refusal, {1e-6, 1.0}, "",
                      "targets failure, accepted_failure: greatest rate of refusals"),
      Parameter::Real("cost_of_failure", &t.cost_of_failure, {0.0, 1e6}, "", "target risk: of a trial"),
      Parameter::Real("cost_of_refusal", &t.cost_of_refusal, {0.0, 1e6}, "", "target risk: of a trial"),
      Parameter::Real("delta", &t.delta, {1e-6, 0.5}, "",
                      "greatest probability that the tuned setting violates its target"),
      Parameter::Integer("explore", &t.explore, {1, 1e7}, per_condition + "to look for settings"),
      Parameter::Integer("calibrate", &t.calibrate, {1, 1e7}, per_condition + "to certify one of them"),
      Parameter::Integer("verify", &t.verify, {1, 1e7}, per_condition + "to measure it afterwards"),
  };
}

size_t NumSettings(const Tuning& tuning) {
  size_t num_settings = 1;
  for (const TunedOption& option : tuning.options) num_settings *= option.levels.size();
  return num_settings;
}

std::vector<std::string> LevelsOfSetting(const Tuning& tuning, size_t setting) {
  std::vector<std::string> levels(tuning.options.size());
  for (size_t o = levels.size(); o-- > 0;) {
    const std::vector<std::string>& all = tuning.options[o].levels;
    levels[o] = all[setting % all.size()];
    setting /= all.size();
  }
  return levels;
}

EstimatorSpec WithLevels(const Tuning& tuning, const std::vector<std::string>& levels, EstimatorSpec spec) {
  Settings options;
  for (size_t o = 0; o < levels.size(); ++o) options.emplace_back(tuning.options[o].name, levels[o]);
  SetOptions(&spec, options);
  return spec;
}

}  // namespace rcme
