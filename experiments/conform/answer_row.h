#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "estimator/conform/visible_features.h"
#include "stats/constants.h"

namespace rcme {

// An answer of a trial whose truth is known: what is seen of it, and how wrong it is.
struct AnswerRow {
  std::int64_t group = 0;  // answers of different groups are independent
  double share = 1.0;      // 1 / problems of its group
  VisibleFeatures features{};
  double nees = 0.0;           // of the stated covariance, 5 degrees of freedom; infinite: it covers nothing
  double max_error_deg = 0.0;  // the greater of rotation and direction error; infinite: no valid motion
  double log_det = 0.0;        // log det of the stated covariance (rad^2)
  bool is_wrong = false;       // beyond the failure bounds, or no valid motion
  // Where the truth has an error of its own (Truth::sd); promises take it as exact. `nees` with that error in
  // the covariance, NaN where the truth has none; and whether two of its standard deviations could make a
  // right answer wrong or a wrong one right.
  double nees_of_inexact_truth = kNaN;
  bool is_wrong_by_truth = false;
};

// A trial whose answer is a row, or a refusal.
struct AskedProblem {
  std::int64_t group = 0;
  bool is_refused = false;
};

struct AnswerRows {
  std::vector<AnswerRow> rows;
  std::vector<AskedProblem> problems;  // answered and refused ones
  std::int64_t num_unscored = 0;       // trials without the truth of their answer, or without a problem

  // Sets the shares of the rows from the problems.
  void SetShares();
  // Those of some groups.
  AnswerRows Part(const std::function<bool(std::int64_t group)>& is_wanted) const;
  std::int64_t CountGroups() const;  // also those without an answer
  std::int64_t CountRefusals() const;
  bool HasSharedGroups() const;  // some group has several problems
};

// A number for each group, in an order that says nothing of them: the same for the same groups.
std::map<std::int64_t, size_t> ShuffleGroups(const AnswerRows& answers);

}  // namespace rcme
