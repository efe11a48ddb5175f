#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "experiments/real/truth_free/validate.h"
#include "parameters/settings.h"

namespace rcme {

// What a report shows, and what it may come from, in words. To be looked at; nothing here can be tried.
std::vector<std::string> FindReasons(const SetReport& report);

// An estimator that can be made again with further options.
struct AdvisedEstimator {
  std::function<std::unique_ptr<MotionEstimator>(const Settings&)> make;
  bool is_robust = false;  // covariance=robust
  double factor = 1.0;     // covariance_factor
};

// Validate, and what to change, each with what came of it: every change is made, with those that were taken
// before, and the set is validated again.
//   the assumed sigma     where the residuals say another one
//   the camera            where a fault is named
//   the covariance        where it is too small or too large: covariance=robust, then with a
//   covariance_factor
//                         measured on that
// A change after which its own fault is still found is withdrawn, and the advice says so.
SetReport ValidateAndAdvise(const PairSet& set, const AdvisedEstimator& estimator,
                            const ValidationOptions& options, KeptSteps* steps = nullptr);

}  // namespace rcme
