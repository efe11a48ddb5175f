#include "experiments/ask/accept_rule.h"

#include <iterator>

namespace rcme {
namespace {

// The rules to try; fixed before any trial.
constexpr double kProbabilities[] = {0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 1.0};

// The level for one rule of one estimator.
double ComputeDelta(int num_estimators) {
  return 0.05 / (static_cast<double>(std::size(kProbabilities)) * num_estimators);
}

}  // namespace

std::optional<AcceptRule> CertifyAcceptRule(const std::vector<StatedAnswer>& answers, std::int64_t num_trials,
                                            double at_most, int num_estimators) {
  std::optional<AcceptRule> greatest;
  for (const double probability : kProbabilities) {
    ErrorCount accepted;
    for (const StatedAnswer& answer : answers) {
      if (answer.failure_probability > probability) continue;
      ++accepted.n;
      accepted.errors += answer.has_failed;
    }
    if (ExcessPValue(accepted, at_most) <= ComputeDelta(num_estimators))
      greatest = AcceptRule{probability, accepted, num_trials};
  }
  return greatest;
}

std::int64_t FewestCertifyingAnswers(double at_most, int num_estimators) {
  return FewestCertifyingTrials(at_most, ComputeDelta(num_estimators));
}

}  // namespace rcme
