// Trains the models of a rule, which predict difficulty and failure from the visible features of an answer.
// The answers used here must not set promises (fit_rule.h).
#pragma once

#include <cstddef>
#include <vector>

#include "estimator/conform/conform_rule.h"
#include "experiments/conform/answer_row.h"

namespace rcme {

// Whether at most one in twenty answers lacks the feature.
bool HasFeature(const std::vector<AnswerRow>& rows, size_t feature);

// The model's log odds for each row.
std::vector<double> ComputeLogOdds(const FeatureModel& model, const std::vector<AnswerRow>& rows);

// Sets the rule's models of difficulty and failure.
void TrainModels(const std::vector<AnswerRow>& rows, ConformRule* rule);

// Sets untrained models: none of difficulty; failure by the stated odds or, if the estimator states none, by
// the number of agreeing matches.
void UseNoModel(const std::vector<AnswerRow>& rows, ConformRule* rule);

// Edges between strata of difficulty that have equally many of `rows` each. Chooses the most strata, at most
// ten, for which each has enough groups to set its factor, counted by the shares of its answers. The factors
// are set by `factor` times as many groups as `rows` have.
std::vector<double> ChooseEdges(const FeatureModel& difficulty, const std::vector<AnswerRow>& rows,
                                double factor, double level);

}  // namespace rcme
