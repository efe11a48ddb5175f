// Stored form of the steps of `rcme twin` and `rcme validate` (core/work/kept_steps.h).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "experiments/core/work/kept_steps.h"
#include "experiments/real/truth_free/pair_set.h"
#include "experiments/real/truth_free/residual_pattern.h"
#include "experiments/real/truth_free/twin_source.h"

namespace rcme {

// The fields that are used here: status, motion, covariance, inliers, estimated noise, probabilities.
nlohmann::ordered_json AnswerAsJson(const MotionEstimate& estimate);
// Throws std::exception if no estimator can return this estimate for `num_matches` matches.
MotionEstimate AnswerFrom(const nlohmann::ordered_json& json, size_t num_matches);

nlohmann::ordered_json ProductsAsJson(const ResidualProducts& products);
ResidualProducts ProductsFrom(const nlohmann::ordered_json& json);

// AnswerTo (twin_source.h) as a step.
MotionEstimate TakeAnswer(const MotionProblem& problem, const MotionEstimator& estimator,
                          const StreamName& name, KeptSteps* steps);
ResidualPattern TakePattern(const std::function<ResidualPattern()>& compute, KeptSteps* steps);

// Identifies a set in the identity of a plan: "kitti00: 30 pairs, checksum 1f2e3d4c".
std::string DescribePairs(const PairSet& set);

}  // namespace rcme
