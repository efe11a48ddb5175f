#pragma once

#include <vector>

#include "estimator/inlier_quality.h"
#include "estimator/sample.h"

namespace rcme {

struct Candidate {
  HypothesisId id;
  InlierScore score;
  double z_statistic = 0.0;
};

// C (eq::candidate-set): the hypotheses that passed the quality test and meet the size condition n_j / n >=
// lambda omega_p. If no omega_p is given, it is inferred as in RANSAC: the largest n_j / n of any hypothesis
// that passed the quality test. MeetsSizeCondition uses the omega_p of the hypotheses added so far, so the
// set is final only after the last Add.
class CandidateSet {
 public:
  CandidateSet(const RansacOptions& options, int num_matches);

  void Add(const Candidate& candidate);
  bool MeetsSizeCondition(const Candidate& candidate) const;
  int CountMembers() const;

  // The best members, at most `count`, sorted best first; of equal scores the one added first comes first.
  // Empty if C is empty.
  std::vector<Candidate> SelectBest(int count, DecidingScore decides) const;

 private:
  std::vector<Candidate> passed_;
  double lambda_, inlier_ratio_;
  bool is_ratio_inferred_;
  int num_matches_;
};

}  // namespace rcme
