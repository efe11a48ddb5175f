// A tuning as JSON for plots/tune.py, and the parts that the plot of a transfer shares.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "experiments/tuning/entropy_roc.h"
#include "experiments/tuning/tune.h"

namespace rcme {

// Rates of every setting, the path, the choice, the other estimators, the ROC curves (thinned to a few
// hundred points).
std::string TuneAsJson(const StudyPlan& plan, const SettingPlan& settings, const TuneResult& result,
                       const std::vector<EntropyRoc>& rocs);

// The target and the options of a tuning, as both plots read them.
nlohmann::ordered_json TargetAsJson(const Tuning& tuning);
nlohmann::ordered_json OptionsAsJson(const Study& study);

}  // namespace rcme
