// The trials of a run as a reader of them sees them, in one result file or in two of the same study, whose
// estimators have then answered the same problems.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "experiments/run/store/result_store.h"

namespace rcme {

using VisitTrial = std::function<void(const ProblemRecord&, const std::vector<TrialRecord>&)>;

struct ReadableRun {
  RunDescription description;
  // Every trial, ordered by condition and trial; its records are ordered by estimator of the description.
  std::function<void(const VisitTrial&)> for_each_trial;
};

// The store outlives it.
ReadableRun ReadRun(const ResultStore& store);

// Some of the estimators of two stores, which outlive it, in the trials that both hold: those of the first,
// then those of the second. A label that both have gets "_old" and "_new". Throws InputError where the
// studies differ in more than their estimators; reading throws it at the first trial whose problem is not the
// same in both, by the numbers that are stored of it. Holds the trials of one condition.
ReadableRun JoinRuns(const ResultStore& first, const std::vector<size_t>& of_first, const ResultStore& second,
                     const std::vector<size_t>& of_second);

// What the problems of a run depend on, of its identity: all but its name and its estimators.
std::string IdentityOfProblems(const std::string& identity);

// Two labels that differ: as they are, or with "_old" and "_new".
void TellApart(std::string* old_label, std::string* new_label);

}  // namespace rcme
