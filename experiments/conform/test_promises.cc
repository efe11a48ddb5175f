#include "experiments/conform/test_promises.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "experiments/conform/fit_rule.h"
#include "stats/beta_binomial.h"
#include "stats/distributions.h"
#include "stats/random.h"
#include "stats/risk_control.h"

namespace rcme {
namespace {

bool IsCovered(const JudgedAnswer& answer) {
  return answer.row.nees <= answer.verdict.factor * ChiSquareQuantile(5, answer.level);
}

// Draws one problem of each group at random and returns those that have an answer.
std::vector<const JudgedAnswer*> DrawOneOfEachGroup(const std::vector<JudgedAnswer>& judged) {
  std::map<std::int64_t, std::vector<const JudgedAnswer*>> groups;
  for (const JudgedAnswer& answer : judged) groups[answer.row.group].push_back(&answer);
  RandomStream rng({.seed = 1, .condition = 0, .trial = 0, .purpose = 5});
  std::vector<const JudgedAnswer*> drawn;
  for (const auto& [group, answers] : groups) {
    const double place = rng.Uniform() / answers.front()->row.share;  // among the group's problems
    if (place < static_cast<double>(answers.size())) drawn.push_back(answers[static_cast<size_t>(place)]);
  }
  return drawn;
}

double ComputeCoveragePValue(const ConformRule& rule, const std::vector<const JudgedAnswer*>& drawn) {
  const ConformOrigin& origin = rule.origin;
  const auto counted = static_cast<double>(std::min(origin.num_answers, origin.num_groups));
  const double n = std::floor((1.0 - kTrainedShare) * counted);
  const auto covered =
      std::ranges::count_if(drawn, [](const JudgedAnswer* answer) { return IsCovered(*answer); });
  return BetaBinomialCdf(covered, std::ssize(drawn), rule.level * (n + 1.0), (1.0 - rule.level) * (n + 1.0));
}

// Tests the equivalent hypothesis "the rate of all other problems is at least 1 - r".
double ComputeAcceptPValue(const ConformRule& rule, const AnswerRows& answers,
                           const std::vector<JudgedAnswer>& judged, std::int64_t num_groups) {
  double loss = 0.0;
  for (const JudgedAnswer& answer : judged)
    if (answer.row.is_wrong && answer.verdict.is_accepted) loss += answer.row.share;
  const double others = 1.0 - rule.wrong_and_accepted;
  if (answers.HasSharedGroups())
    return MeanLossPValue(1.0 - loss / static_cast<double>(num_groups), num_groups, others);
  return ExcessPValue({num_groups - std::llround(loss), num_groups}, others);
}

}  // namespace

PromiseFinding TestPromises(const ConformRule& rule, const AnswerRows& answers,
                            const std::vector<JudgedAnswer>& judged) {
  PromiseFinding finding;
  const std::vector<const JudgedAnswer*> drawn = DrawOneOfEachGroup(judged);
  finding.num_answers = std::ssize(drawn);
  finding.num_problems = answers.CountGroups();
  finding.coverage_p_value = ComputeCoveragePValue(rule, drawn);
  if (finding.num_problems > 0)
    finding.accept_p_value = ComputeAcceptPValue(rule, answers, judged, finding.num_problems);
  return finding;
}

}  // namespace rcme
