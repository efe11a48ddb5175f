#include "stats/score_mean.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace rcme {
namespace {

// Stakes, as shares of the loss at the least score. For n scores of mean m and standard deviation s the best
// stake is about 3 m / (s sqrt(n)). If most scores are near the top, the lower bound depends on the great
// stakes, so these are denser.
constexpr std::array<double, 14> kShares = {0.95, 0.85, 0.7,  0.55, 0.4,   0.28,   0.2,
                                            0.14, 0.1,  0.07, 0.05, 0.025, 0.0125, 0.00625};

// log K_n(m); infinite at 0, which is the mean only of scores that are all zero.
double LogCapitalAbove(const std::vector<CountedNumber>& numbers, double m) {
  return m > 0.0 ? LogCapital(numbers, m, kShares, 1.0 / m) : std::numeric_limits<double>::infinity();
}
bool IsExcluded(const std::vector<CountedNumber>& numbers, double m, double needed) {
  return !(m > 0.0) || IsCapitalAtLeast(needed, numbers, m, kShares, 1.0 / m);
}

}  // namespace

void ScoreMean::Add(double score, std::int64_t count) {
  if (!(score >= range_.lower && score <= range_.upper))
    throw std::invalid_argument("mean of scores: a score outside of its range");
  if (count == 0) return;
  if (counts_.empty()) counts_.assign(kNumSteps + 1, 0.0);
  const double at = kNumSteps * (score - range_.lower) / (range_.upper - range_.lower);
  const int below = std::min(static_cast<int>(at), kNumSteps - 1);
  const double times = static_cast<double>(count);
  counts_[static_cast<size_t>(below)] += times * (1.0 - (at - below));
  counts_[static_cast<size_t>(below) + 1] += times * (at - below);
  sum_ += times * score;
  n_ += count;
}

ScoreMean ScoreMean::OnGrid(const std::vector<double>& counts, std::int64_t n, double sum) {
  ScoreMean scores;
  if (n == 0) return scores;
  if (counts.size() != kNumSteps + 1) throw std::invalid_argument("mean of scores: another grid");
  scores.counts_ = counts;
  scores.n_ = n;
  scores.sum_ = sum;
  return scores;
}

double ScoreMean::mean() const { return sum_ / static_cast<double>(n_); }

double ScoreMean::standard_deviation() const {
  return (range_.upper - range_.lower) * InUnitRange(false).standard_deviation;
}

ScoreMean::UnitScores ScoreMean::InUnitRange(bool is_mirrored) const {
  UnitScores scores;
  double sum = 0.0, squares = 0.0;
  for (size_t i = 0; i < counts_.size(); ++i) {
    if (counts_[i] == 0.0) continue;
    const double at = static_cast<double>(i) / kNumSteps, x = is_mirrored ? 1.0 - at : at;
    scores.numbers.push_back({x, counts_[i]});
    sum += counts_[i] * x;
    squares += counts_[i] * x * x;
  }
  const double n = static_cast<double>(n_);
  scores.mean = sum / n;
  scores.standard_deviation = std::sqrt(std::max(0.0, squares / n - scores.mean * scores.mean));
  scores.distance = std::max((scores.standard_deviation + 1.0 / kNumSteps) / std::sqrt(n), 1e-6);
  return scores;
}

Interval ScoreMean::Sequence(double confidence) const {
  if (n_ == 0) return range_;
  const double needed = -std::log(0.5 * (1.0 - confidence));
  const auto lower_bound = [&](bool is_mirrored) {
    const UnitScores scores = InUnitRange(is_mirrored);
    if (!(scores.mean > 0.0)) return 0.0;
    return GreatestExcluded(scores.mean, scores.distance,
                            [&](double m) { return IsExcluded(scores.numbers, m, needed); });
  };
  const double size = range_.upper - range_.lower;
  return {range_.lower + size * lower_bound(false), range_.upper - size * lower_bound(true)};
}

double ScoreMean::LogCapitalAt(double mean, bool is_mirrored) const {
  if (!(mean > range_.lower && mean < range_.upper))
    throw std::invalid_argument("mean of scores: a mean at the end of its range or outside");
  if (n_ == 0) return 0.0;
  const double m = (mean - range_.lower) / (range_.upper - range_.lower);
  return LogCapitalAbove(InUnitRange(is_mirrored).numbers, is_mirrored ? 1.0 - m : m);
}

double ScoreMean::PValue(double mean) const {
  return std::min(1.0, 2.0 * std::min(PValueOfAtMost(mean), PValueOfAtLeast(mean)));
}

double ScoreMean::PValueOfAtMost(double mean) const {
  return std::min(1.0, std::exp(-LogCapitalAt(mean, false)));
}

double ScoreMean::PValueOfAtLeast(double mean) const {
  return std::min(1.0, std::exp(-LogCapitalAt(mean, true)));
}

}  // namespace rcme
