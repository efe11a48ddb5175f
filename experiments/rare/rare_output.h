#pragma once

#include <string>
#include <vector>

#include "experiments/core/table/command_result.h"
#include "experiments/rare/split_failures.h"
#include "experiments/rare/stratified_failures.h"

namespace rcme {

// One line of the tables.
struct RareRow {
  size_t condition = 0, estimator = 0;
  double estimate = 0.0, standard_error = 0.0;
  Interval interval;
  std::int64_t num_calls = 0;       // of the estimator
  double unseen_up_to = 1.0;        // the upper end that allows for failures of another kind
  double relative_spread = 0.0;     // of replicates; NaN: there are none
  std::vector<std::string> doubts;  // none: the rate is trusted

  // Calls, of those after which plain trials would have the same standard error.
  double BruteForceShare() const;
};
RareRow MakeRareRow(const RareCell& cell);
// Doubted ("few_failures") below kLeastFailures of them: the interval is that of hardly any.
RareRow MakeRareRow(const StratifiedCell& cell);
inline constexpr double kLeastFailures = 3.0;  // as many of equal weight as have the same relative error

// For people: a row for each condition and estimator, and why a rate is not to be trusted.
std::string RareAsTable(const StudyPlan& plan, const RareEvent& event, const std::vector<RareCell>& cells);
std::string StratifiedAsTable(const StudyPlan& plan, const std::vector<StratifiedCell>& cells);

// Rows of `rcme summarize --format csv`, the event as their quantity, with more columns: trusted, doubts,
// unseen_up_to, relative_spread, brute_force_share. n counts calls of the estimator.
Table MakeRareFileTable(const StudyPlan& plan, const RareEvent& event, const std::vector<RareRow>& rows);

// These, in JSON also the levels of the error and the replicates of splitting, or the strata.
CommandResult MakeRareResult(const StudyPlan& plan, const RareEffort& effort,
                             const std::vector<RareCell>& cells);
CommandResult MakeStratifiedResult(const StudyPlan& plan, const StratifiedEffort& effort,
                                   const std::vector<StratifiedCell>& cells);

}  // namespace rcme
