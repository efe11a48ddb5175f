// The problems on which an estimator's contract is checked.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/data/data_source.h"

namespace rcme {

struct ContractProblem {
  std::string name;
  MotionProblem problem;
  StreamName stream;                                // of its samples, purpose kSampling
  bool has_no_motion = false;                       // only a refusal is right
  std::optional<RelativePose> cam2_from_cam1_true;  // if the answer must be right
};

// Every scene, with many and with few matches, with no and with mostly wrong ones.
std::vector<ContractProblem> OrdinaryProblems(std::uint64_t seed);

// Problems on which no estimator should fail: 100 true matches of an ordinary scene, noise of .1 px.
std::vector<ContractProblem> EasyProblems(std::uint64_t seed);

// Inputs that real data and broken programs produce: numbers that are not finite or huge, too few matches,
// repeated matches, points on a line, cameras without an inverse.
std::vector<ContractProblem> BadProblems(std::uint64_t seed);

// 10^5 matches, 30 % of them wrong.
ContractProblem LargeProblem(std::uint64_t seed);

}  // namespace rcme
