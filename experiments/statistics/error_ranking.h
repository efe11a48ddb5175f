// Measures how well an estimator's stated uncertainty ranks its errors (stats/sparsification.h): the
// rotation error by rotation_sd_deg, the direction error by direction_sd_deg. It uses all returned motions
// with a covariance and a known truth, including failures.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/statistics/summarize.h"
#include "stats/sparsification.h"

namespace rcme {

// The errors of one estimator in one condition or group of trials. A ranking needs all errors at once: 48
// bytes per trial, at most 2^20 trials. Beyond that, it keeps every second trial, then every fourth, and so
// on.
class ErrorRanking {
 public:
  static constexpr size_t kMostErrors = size_t{1} << 20;

  void Add(const TrialRecord& record);
  // Later additions are independent of earlier ones.
  void EndCluster() { ++cluster_; }
  // Adds the clusters of `other` as further clusters.
  void Merge(const ErrorRanking& other);

  // `cell` has the values common to all rows. n counts trials, or clusters if `counts_clusters`.
  void AppendRows(const SummaryRow& cell, bool counts_clusters, std::vector<SummaryRow>* rows) const;

 private:
  std::int64_t cluster_ = 0;
  std::int64_t num_seen_ = 0, stride_ = 1;
  std::vector<StatedError> rotations_, directions_;  // deg; nothing if the direction is unknown
};

// Returns the names of the rows and their explanations, for `rcme list quantities`.
const std::vector<QuantityHelp>& ErrorRankingQuantities();
bool IsOfErrorRanking(const std::string& quantity);

}  // namespace rcme
