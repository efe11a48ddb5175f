// The trials of a run for a reader: those of one result file, or of two files of the same study, whose
// estimators have answered the same problems.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiments/run/store/result_store.h"

namespace rcme {

using VisitTrial = std::function<void(const ProblemRecord&, const std::vector<TrialRecord>&)>;

struct ReadableRun {
  RunDescription description;
  // Visits every trial, ordered by condition and trial, with records ordered by the estimators of the
  // description.
  std::function<void(const VisitTrial&)> for_each_trial;
};

// The store must outlive the result.
ReadableRun ReadRun(const ResultStore& store);

// The same run with only the trials of the conditions with this level of a factor of the run.
ReadableRun SelectLevel(const ReadableRun& run, const std::string& factor, const std::string& level);
// The same run with only the trials of these problems.
ReadableRun SelectTrials(const ReadableRun& run, std::function<bool(const ProblemRecord&)> is_kept);

// Joins some estimators of two stores, which must outlive the result, in the trials that both hold: first
// those of `first`, then those of `second`. A label that occurs in both gets "_old" and "_new". Throws
// InputError if the studies differ in more than their estimators; reading throws InputError at the first
// trial whose stored problem numbers differ. Holds the trials of one condition in memory.
ReadableRun JoinRuns(const ResultStore& first, const std::vector<size_t>& of_first, const ResultStore& second,
                     const std::vector<size_t>& of_second);

// Makes two labels different by appending "_old" and "_new" if they are equal.
void TellApart(std::string* old_label, std::string* new_label);

}  // namespace rcme
