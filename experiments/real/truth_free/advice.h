#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "experiments/real/truth_free/validate.h"
#include "parameters/settings.h"

namespace rcme {

// Findings of a report and their possible causes, in words. These are hints for the user: ValidateAndAdvise
// cannot try them.
std::vector<std::string> FindReasons(const SetReport& report);

// An estimator that can be made again with further options.
struct AdvisedEstimator {
  std::function<std::unique_ptr<MotionEstimator>(const Settings&)> make;
  bool is_robust = false;  // covariance=robust
  double factor = 1.0;     // covariance_factor
};

// Validates the set, tries changes one after the other and reports the outcome of each as advice. Each trial
// includes the changes accepted before and validates the set again:
//   assumed sigma   if the residuals give another one: that one, in up to three rounds
//   camera          if a fault is named: the pairs corrected for it
//   covariance      if too small or too large: covariance=robust, then also a covariance_factor that is
//                   measured with covariance=robust
// A change of camera or covariance that does not remove its fault is dropped, and the report says so.
SetReport ValidateAndAdvise(const PairSet& set, const AdvisedEstimator& estimator,
                            const ValidationOptions& options, KeptSteps* steps = nullptr);

}  // namespace rcme
