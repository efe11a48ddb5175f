// The part of a rule that may be chosen freely: models of what can be seen of an answer, trained by answers
// that set no promise (fit_rule.h).
#pragma once

#include <cstddef>
#include <vector>

#include "estimator/conform/conform_rule.h"
#include "experiments/conform/answer_row.h"

namespace rcme {

// Whether at most one in twenty answers lacks the feature.
bool HasFeature(const std::vector<AnswerRow>& rows, size_t feature);

// Of each row by the model, log odds.
std::vector<double> ComputeLogOdds(const FeatureModel& model, const std::vector<AnswerRow>& rows);

// Sets the rule's models of difficulty and failure.
void TrainModels(const std::vector<AnswerRow>& rows, ConformRule* rule);

// Without training: no difficulty, and the failure by the stated odds or, where the estimator states none, by
// the number of agreeing matches.
void UseNoModel(const std::vector<AnswerRow>& rows, ConformRule* rule);

// Edges of strata of difficulty, with equally many of these answers between two; as many strata as leave each
// of them groups enough, counted by the shares of its answers, once `factor` times as many answers set its
// factor.
std::vector<double> ChooseEdges(const FeatureModel& difficulty, const std::vector<AnswerRow>& rows,
                                double factor, double level);

}  // namespace rcme
