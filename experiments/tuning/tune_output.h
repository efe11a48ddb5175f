#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "experiments/tuning/entropy_roc.h"
#include "experiments/tuning/tune.h"

namespace rcme {

// What was asked, tuned and verified, for people. Without a choice: what was tried.
std::string TuneAsTable(const StudyPlan& plan, const TuneResult& result, const std::vector<EntropyRoc>& rocs);

// How often a repeated tuning violated its target, for people.
std::string RepetitionsAsTable(const StudyPlan& plan, const SettingPlan& settings,
                               const Repetitions& repetitions);

// All of it for plots/tune.py: rates of every setting, the path, the choice, the other estimators, the ROC
// curves (thinned to a few hundred points).
std::string TuneAsJson(const StudyPlan& plan, const SettingPlan& settings, const TuneResult& result,
                       const std::vector<EntropyRoc>& rocs);

// Where the tuned estimator comes from and what it was seen to do: (key, text) pairs for its file.
std::vector<std::pair<std::string, std::string>> ProvenanceOf(const StudyPlan& plan,
                                                              const TuneResult& result);

// The target and the options of a tuning, as both plots read them.
nlohmann::ordered_json TargetAsJson(const Tuning& tuning);
nlohmann::ordered_json OptionsAsJson(const Study& study);
// {"value", "lower", "upper", "n"}: the rate with its exact 95 % interval; value null where n is 0.
nlohmann::ordered_json RateAsJson(const ErrorCount& count);
// "1.23 % [1.01, 1.50]"; "-" where n is 0.
std::string RateForTable(const ErrorCount& count);

}  // namespace rcme
