// The problems on which an estimator is put through its contract.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/data/data_source.h"

namespace rcme {

struct ContractProblem {
  std::string name;
  MotionProblem problem;
  StreamName stream;                                // of the samples, purpose kSampling
  bool has_no_motion = false;                       // nothing but a refusal can be right
  std::optional<RelativePose> cam2_from_cam1_true;  // where the answer has to be right
};

// Every scene, each with many and with few matches, none and most of them wrong.
std::vector<ContractProblem> OrdinaryProblems(std::uint64_t seed);

// Problems that no estimator should fail on: 100 true matches of an ordinary scene, noise of .1 px.
std::vector<ContractProblem> EasyProblems(std::uint64_t seed);

// What real data and broken programs bring: numbers that are not finite or huge, too few matches, the same
// ones again and again, points on a line, cameras without an inverse.
std::vector<ContractProblem> BadProblems(std::uint64_t seed);

// 10^5 matches, 30 % of them wrong.
ContractProblem LargeProblem(std::uint64_t seed);

}  // namespace rcme
