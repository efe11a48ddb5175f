#include "estimator/candidate_set.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "estimator/solvers/solver_table.h"

namespace rcme {

CandidateSet::CandidateSet(const RansacOptions& options, int num_matches)
    : lambda_(options.lambda),
      inlier_ratio_(std::isnan(options.inlier_ratio) ? 0.0 : options.inlier_ratio),
      is_ratio_inferred_(std::isnan(options.inlier_ratio)),
      num_matches_(num_matches) {
  const int most = FindMaxModels(options.solver) * std::min(options.num_iterations, 4096);
  passed_.reserve(static_cast<size_t>(std::min(most, 4096)));
}

void CandidateSet::Add(const Candidate& candidate) {
  passed_.push_back(candidate);
  if (is_ratio_inferred_) {
    inlier_ratio_ = std::max(inlier_ratio_, static_cast<double>(candidate.score.num_inliers) / num_matches_);
  }
}

// n_j / n >= lambda omega_p (eq:inlier_size_cond)
bool CandidateSet::MeetsSizeCondition(const Candidate& candidate) const {
  const double bound = lambda_ * inlier_ratio_ * num_matches_;
  return candidate.score.num_inliers >= bound * (1.0 - 1e-12);  // n_j / n * n may round to more than n_j
}

// |C|: the number of hypotheses that passed the quality test and meet the size condition (eq::candidate-set).
int CandidateSet::CountMembers() const {
  return static_cast<int>(std::count_if(passed_.begin(), passed_.end(), [this](const Candidate& candidate) {
    return MeetsSizeCondition(candidate);
  }));
}

// eq::model_select_entropy: the best by `decides`, over C.
std::vector<Candidate> CandidateSet::SelectBest(int count, DecidingScore decides) const {
  std::vector<const Candidate*> members;
  members.reserve(passed_.size());
  for (const Candidate& candidate : passed_) {
    if (MeetsSizeCondition(candidate)) members.push_back(&candidate);
  }
  const auto end = members.begin() + std::min<std::ptrdiff_t>(count, std::ssize(members));
  std::partial_sort(members.begin(), end, members.end(), [&](const Candidate* a, const Candidate* b) {
    return IsBetter(a->score, b->score, decides) || (!IsBetter(b->score, a->score, decides) && a < b);
  });
  std::vector<Candidate> best;
  best.reserve(static_cast<size_t>(end - members.begin()));
  std::transform(members.begin(), end, std::back_inserter(best), [](const Candidate* c) { return *c; });
  return best;
}

}  // namespace rcme
