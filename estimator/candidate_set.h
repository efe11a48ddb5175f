#pragma once

#include <optional>
#include <vector>

#include "estimator/hypothesis.h"
#include "estimator/inlier_quality.h"

namespace rcme {

struct Candidate {
  Sample sample{};
  InlierScore score;
  double z_statistic = 0.0;
};

// C (eq::candidate-set): the hypotheses that passed the quality test, and the size condition n_j / n >=
// lambda omega_p. omega_p is given, or the largest n_j / n of any hypothesis that passed, as RANSAC infers
// it; the size condition is therefore decided with the last omega_p.
class CandidateSet {
 public:
  CandidateSet(const RansacOptions& options, int num_matches);

  void Add(const Candidate& candidate);
  bool MeetsSizeCondition(const Candidate& candidate) const;
  int CountMembers() const;

  // The best member in the order of `Better` (the first one at a tie); nothing if C is empty.
  template <typename Better>
  std::optional<Candidate> Select(Better better) const {
    const Candidate* best = nullptr;
    for (const Candidate& candidate : passed_) {
      if (MeetsSizeCondition(candidate) && (!best || better(candidate.score, best->score))) best = &candidate;
    }
    return best ? std::optional<Candidate>(*best) : std::nullopt;
  }

 private:
  std::vector<Candidate> passed_;
  double lambda_, inlier_ratio_;
  bool is_ratio_inferred_;
  int num_matches_;
};

}  // namespace rcme
