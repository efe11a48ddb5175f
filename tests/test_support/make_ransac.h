// Estimators of the RANSAC family from options in the code.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "estimator/estimators/rcme.h"
#include "estimator/estimators/standard.h"
#include "estimator/solvers/solver_list.h"

namespace rcme {

inline std::unique_ptr<MotionEstimator> MakeRansac(const std::string& name, const RansacOptions& options) {
  if (name == "standard") return MakeStandard(options);
  return MakeRcme(options, name == "rcme" ? SampleTest::kOn : SampleTest::kOff);
}

// Every option of the family, whichever estimator shows it.
inline std::vector<Parameter> AllParameters(RansacOptions& options) {
  std::vector<Parameter> all = Parameters(options);
  for (const Parameter& p : EntropyParameters(options)) all.push_back(p);
  all.push_back(SampleTestParameter(options));
  for (const Parameter& p : MotionTestParameters(options, true)) all.push_back(p);
  return all;
}

}  // namespace rcme
