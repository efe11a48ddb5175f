// How well an estimator's stated uncertainty ranks its errors (stats/sparsification.h): the rotation's error
// by rotation_sd_deg, the direction's by direction_sd_deg, of returned motions with a covariance and a known
// truth, failures among them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/statistics/summarize.h"
#include "stats/sparsification.h"

namespace rcme {

// Of one estimator in one condition or group of trials, growing trial by trial. A ranking needs all errors at
// once: 48 bytes for a trial, at most 2^20 trials; of more, every second one, fourth one, ... evenly over
// them.
class ErrorRanking {
 public:
  static constexpr size_t kMostErrors = size_t{1} << 20;

  void Add(const TrialRecord& record);
  // What is added from here on is independent of what was added.
  void EndCluster() { ++cluster_; }
  // As clusters of their own.
  void Merge(const ErrorRanking& other);

  // `cell` holds what the rows share. n counts trials; clusters where `counts_clusters`.
  void AppendRows(const SummaryRow& cell, bool counts_clusters, std::vector<SummaryRow>* rows) const;

 private:
  std::int64_t cluster_ = 0;
  std::int64_t num_seen_ = 0, stride_ = 1;
  std::vector<StatedError> rotations_, directions_;  // deg; of an unknown direction none
};

// The names of the rows and what they are, for `rcme list quantities`.
const std::vector<QuantityHelp>& ErrorRankingQuantities();
bool IsOfErrorRanking(const std::string& quantity);

}  // namespace rcme
