#pragma once

#include <cstdint>
#include <vector>

#include "estimator/conform/visible_features.h"

namespace rcme {

// An answer of a trial whose truth is known: what is seen of it, and how wrong it is.
struct AnswerRow {
  std::int64_t group = 0;  // answers of different groups are independent
  VisibleFeatures features{};
  double nees = 0.0;           // of the stated covariance, 5 degrees of freedom; infinite: it covers nothing
  double max_error_deg = 0.0;  // the greater of rotation and direction error; infinite: no valid motion
  double log_det = 0.0;        // log det of the stated covariance (rad^2)
  bool is_wrong = false;       // beyond the failure bounds, or no valid motion
};

struct AnswerRows {
  std::vector<AnswerRow> rows;
  std::int64_t num_refusals = 0, num_unscored = 0;  // trials without an answer, or without the truth of one
};

}  // namespace rcme
