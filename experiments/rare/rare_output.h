#pragma once

#include <string>
#include <vector>

#include "experiments/core/table/command_result.h"
#include "experiments/rare/split_failures.h"
#include "experiments/rare/stratified_failures.h"

namespace rcme {

// One row of the tables.
struct RareRow {
  size_t condition = 0, estimator = 0;
  double estimate = 0.0, standard_error = 0.0;
  Interval interval;
  std::int64_t num_calls = 0;       // calls of the estimator
  double unseen_up_to = 1.0;        // the upper end if failures of another kind are allowed for
  double relative_spread = 0.0;     // of the replicates; NaN without replicates
  std::vector<std::string> doubts;  // empty: the rate is trusted

  // Number of calls relative to that of plain trials with the same standard error.
  double BruteForceShare() const;
};
RareRow MakeRareRow(const RareCell& cell);
// Doubted ("few_failures") below kLeastFailures failures, on which no interval can rest.
RareRow MakeRareRow(const StratifiedCell& cell);
// effective number: as many of equal weight have the same relative error
inline constexpr double kLeastFailures = 3.0;
// Doubted ("few_easy_trials") if the upper end as if the next failure were in the easiest stratum is more
// than kMostUnseen times that of the interval: so few easy trials were run that their failures may have been
// missed. An interval that none of them is in says nothing of them.
inline constexpr double kMostUnseen = 2.0;

// A table with one row per condition and estimator, and the reasons why a rate is not to be trusted.
std::string RareAsTable(const StudyPlan& plan, const RareEvent& event, const std::vector<RareCell>& cells);
std::string StratifiedAsTable(const StudyPlan& plan, const std::vector<StratifiedCell>& cells);

// Rows of `rcme summarize --format csv` with the event as the quantity and more columns: trusted, doubts,
// unseen_up_to, relative_spread, brute_force_share. n counts calls of the estimator.
Table MakeRareFileTable(const StudyPlan& plan, const RareEvent& event, const std::vector<RareRow>& rows);

// The results with both tables; JSON also has the levels of the error and the replicates of splitting, or the
// strata.
CommandResult MakeRareResult(const StudyPlan& plan, const RareEffort& effort,
                             const std::vector<RareCell>& cells);
CommandResult MakeStratifiedResult(const StudyPlan& plan, const StratifiedEffort& effort,
                                   const std::vector<StratifiedCell>& cells);

}  // namespace rcme
