#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "estimator/conform/visible_features.h"
#include "stats/constants.h"

namespace rcme {

// An answer whose truth is known: its features visible at run time, and its errors.
struct AnswerRow {
  std::int64_t group = 0;  // answers of different groups are independent
  double share = 1.0;      // 1 / number of problems in its group
  VisibleFeatures features{};
  double nees = 0.0;           // with the stated covariance, 5 degrees of freedom; infinite: covers nothing
  double max_error_deg = 0.0;  // the greater of rotation and direction error; infinite: no valid motion
  double log_det = 0.0;        // log det of the stated covariance (rad^2)
  bool is_wrong = false;       // error beyond a failure bound, or no valid motion
  // The effect of an error of the truth (Truth::sd); promises take the truth as exact. nees_of_inexact_truth
  // is `nees` with the truth's covariance added, NaN for an exact truth. is_wrong_by_truth: moving the truth
  // by two of its standard deviations could change is_wrong.
  double nees_of_inexact_truth = kNaN;
  bool is_wrong_by_truth = false;
};

// A trial that gave an AnswerRow or a refusal.
struct AskedProblem {
  std::int64_t group = 0;
  bool is_refused = false;
};

struct AnswerRows {
  std::vector<AnswerRow> rows;
  std::vector<AskedProblem> problems;  // answered and refused ones
  std::int64_t num_unscored = 0;       // answers with unknown truth, and trials without a problem

  // Sets the shares of the rows from the problems.
  void SetShares();
  // The rows and problems of the wanted groups.
  AnswerRows Part(const std::function<bool(std::int64_t group)>& is_wanted) const;
  std::int64_t CountGroups() const;  // including groups without an answer
  std::int64_t CountRefusals() const;
  bool HasSharedGroups() const;  // some group has several problems
};

// Numbers the groups 0, 1, ... in a pseudorandom order, which depends on the set of groups alone.
std::map<std::int64_t, size_t> ShuffleGroups(const AnswerRows& answers);

}  // namespace rcme
