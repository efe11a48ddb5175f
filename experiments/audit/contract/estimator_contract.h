// The contract of an estimator (estimator/motion_estimator.h, motion_estimate.h) as checks that can fail.
//
// Each check calls the estimator in a process of its own: a crash, an exit or a call that never returns fails
// the check but not the program. An answer is valid if the score accepts it (answer_check.h).
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "estimator/motion_estimator.h"

namespace rcme {

using EstimatorMaker = std::function<std::unique_ptr<MotionEstimator>()>;

struct ContractOptions {
  std::uint64_t seed = 1;
  double seconds_per_call = 60.0;  // a call that takes longer counts as hanging
  std::string problem;             // only the problem of this name; empty: all
  bool is_isolated = true;         // false: in this process, for a debugger
};

struct ContractCheck {
  std::string name;
  std::string doc;  // what it requires
};
const std::vector<ContractCheck>& ContractChecks();

struct ContractResult {
  bool has_passed = false;
  std::string finding;  // the fault, or what was done
  std::string problem;  // where the fault was found; empty without a fault
};

// Runs one check by its name. Throws InputError if no problem has the requested name.
ContractResult RunContractCheck(const std::string& check, const EstimatorMaker& make,
                                const ContractOptions& options);

}  // namespace rcme
