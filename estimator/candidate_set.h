#pragma once

#include <algorithm>
#include <iterator>
#include <vector>

#include "estimator/inlier_quality.h"
#include "estimator/sample.h"

namespace rcme {

struct Candidate {
  HypothesisId id;
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

  // The best members in the order of `better` (the first one first at a tie), at most `count`; none if C is
  // empty.
  template <typename Better>
  std::vector<Candidate> SelectBest(int count, Better better) const {
    std::vector<const Candidate*> members;
    members.reserve(passed_.size());
    for (const Candidate& candidate : passed_) {
      if (MeetsSizeCondition(candidate)) members.push_back(&candidate);
    }
    const auto end = members.begin() + std::min<std::ptrdiff_t>(count, std::ssize(members));
    std::partial_sort(members.begin(), end, members.end(), [&](const Candidate* a, const Candidate* b) {
      return better(a->score, b->score) || (!better(b->score, a->score) && a < b);
    });
    std::vector<Candidate> best;
    best.reserve(static_cast<size_t>(end - members.begin()));
    std::transform(members.begin(), end, std::back_inserter(best), [](const Candidate* c) { return *c; });
    return best;
  }

 private:
  std::vector<Candidate> passed_;
  double lambda_, inlier_ratio_;
  bool is_ratio_inferred_;
  int num_matches_;
};

}  // namespace rcme
