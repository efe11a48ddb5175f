#include "experiments/conform/set_promises.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "stats/conformal.h"
#include "stats/distributions.h"
#include "stats/logistic_regression.h"
#include "stats/risk_control.h"

namespace rcme {
namespace {

constexpr double kSlopePenalty = 5.0;  // on the deviation of the log odds' slope from 1
constexpr double kEverything = 1e9;    // a threshold that accepts every answer

// From strict to lax; fixed in advance, independently of the answers.
std::vector<double> Thresholds() {
  std::vector<double> thresholds;
  for (int k = -120; k <= 120; ++k) thresholds.push_back(0.1 * k);
  thresholds.push_back(kEverything);
  return thresholds;
}

}  // namespace

double ComputeBound(const std::vector<AnswerRow>& rows, double level, double AnswerRow::*score) {
  std::vector<double> scores, shares;
  for (const AnswerRow& row : rows) {
    scores.push_back(row.*score);
    shares.push_back(row.share);
  }
  return ConformalBound(scores, shares, level);
}

double ComputeFactor(double bound, double level) { return bound / ChiSquareQuantile(5, level); }

void SetFactors(const std::vector<AnswerRow>& rows, ConformRule* rule) {
  std::vector<std::vector<AnswerRow>> strata(rule->edges.size() + 1);
  for (const AnswerRow& row : rows) {
    const double difficulty = rule->difficulty.At(row.features);
    const auto k = std::ranges::upper_bound(rule->edges, difficulty) - rule->edges.begin();
    strata[static_cast<size_t>(k)].push_back(row);
  }
  for (const std::vector<AnswerRow>& stratum : strata)
    rule->factors.push_back(ComputeFactor(ComputeBound(stratum, rule->level, &AnswerRow::nees), rule->level));
}

void CorrectLogOdds(const std::vector<AnswerRow>& rows, ConformRule* rule) {
  std::vector<double> log_odds;
  std::vector<bool> is_wrong;
  for (const AnswerRow& row : rows) {
    log_odds.push_back(rule->failure.At(row.features));
    is_wrong.push_back(row.is_wrong);
  }
  const double one = 1.0;
  const LogisticFit fit = FitLogistic(log_odds, is_wrong, {&one, 1}, kSlopePenalty);
  rule->log_odds_slope = std::max(fit.weights.front(), 0.0);
  rule->log_odds_intercept =
      fit.weights.front() > 0.0
          ? fit.intercept
          : FitLogistic({}, is_wrong, {}, kSlopePenalty).intercept;  // the odds are uninformative
}

std::optional<double> CertifyThreshold(const AnswerRows& answers, const std::vector<double>& scores,
                                       const ConformPromise& promise) {
  const bool shares_groups = answers.HasSharedGroups();
  const std::int64_t n = answers.CountGroups();
  std::vector<std::pair<double, double>> losses;  // score and loss of the wrong answers, ascending
  for (size_t i = 0; i < scores.size(); ++i)
    if (answers.rows[i].is_wrong) losses.emplace_back(scores[i], answers.rows[i].share);
  std::ranges::sort(losses);
  const std::vector<double> thresholds = Thresholds();
  std::vector<double> p_values;
  double loss = 0.0;
  size_t num_wrong = 0;
  for (const double threshold : thresholds) {
    while (num_wrong < losses.size() && losses[num_wrong].first <= threshold)
      loss += losses[num_wrong++].second;
    p_values.push_back(
        shares_groups ? MeanLossPValue(loss / static_cast<double>(n), n, promise.wrong_and_accepted)
                      : ExcessPValue({static_cast<std::int64_t>(num_wrong), n}, promise.wrong_and_accepted));
    if (p_values.back() > promise.risk) break;
  }
  const size_t num_certified = CountCertified(p_values, promise.risk);
  if (num_certified == 0) return std::nullopt;
  return thresholds[num_certified - 1];
}

std::vector<double> ScoreByAgreeing(const std::vector<AnswerRow>& rows) {
  std::vector<double> scores;
  for (const AnswerRow& row : rows) {
    const double agreeing = row.features[static_cast<size_t>(VisibleFeature::kAgreeing)];
    scores.push_back(std::isnan(agreeing) ? kEverything : -agreeing);
  }
  return scores;
}

}  // namespace rcme
