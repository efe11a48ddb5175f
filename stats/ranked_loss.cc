#include "stats/ranked_loss.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace rcme {
namespace {

// The indices of the scores, greatest score first.
std::vector<size_t> GreatestFirst(std::span<const double> scores, std::span<const double> losses) {
  if (scores.empty()) throw std::invalid_argument("ranked losses: there are none");
  if (scores.size() != losses.size())
    throw std::invalid_argument("ranked losses: not as many scores as losses");
  for (size_t i = 0; i < scores.size(); ++i) {
    if (std::isnan(scores[i])) throw std::invalid_argument("ranked losses: a score is NaN");
    if (!std::isfinite(losses[i])) throw std::invalid_argument("ranked losses: a loss is not finite");
  }
  std::vector<size_t> order(scores.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::ranges::stable_sort(order, [&](size_t a, size_t b) { return scores[a] > scores[b]; });
  return order;
}

// Equal scores, ranks first + 1 to last.
struct Tie {
  size_t first = 0, last = 0;
  double loss = 0.0;    // sum
  double weight = 0.0;  // mean of H_n - H_(rank - 1) over the ranks
};

std::vector<Tie> FindTies(std::span<const double> scores, std::span<const double> losses,
                          const std::vector<size_t>& order) {
  std::vector<Tie> ties;
  for (size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || scores[order[i]] != scores[order[i - 1]]) ties.push_back({i, i});
    ties.back().last = i + 1;
    ties.back().loss += losses[order[i]];
  }
  double from_here = 0.0;  // 1 / rank + ... + 1 / n
  for (auto tie = ties.rbegin(); tie != ties.rend(); ++tie) {
    for (size_t rank = tie->last; rank > tie->first; --rank) {
      from_here += 1.0 / static_cast<double>(rank);
      tie->weight += from_here / static_cast<double>(tie->last - tie->first);
    }
  }
  return ties;
}

}  // namespace

RankedLoss MeasureRankedLoss(std::span<const double> scores, std::span<const double> losses) {
  const std::vector<size_t> order = GreatestFirst(scores, losses);
  const std::vector<Tie> ties = FindTies(scores, losses, order);
  const double n = static_cast<double>(scores.size());
  RankedLoss ranked;
  for (const Tie& tie : ties) ranked.area += tie.loss * tie.weight / n, ranked.mean += tie.loss / n;
  ranked.influences.resize(scores.size());
  ranked.mean_influences.resize(scores.size());
  double later = 0.0;  // the integral of r(u) / u from the end of the tie to 1
  for (auto tie = ties.rbegin(); tie != ties.rend(); ++tie) {
    const double count = static_cast<double>(tie->last - tie->first), risk = tie->loss / count;
    // Within a tie r is constant and a trial's own rank is random: take the mean over the ranks of the sum of
    // 1 / rank from that rank on.
    double inner = 0.0, mean_inner = 0.0;
    for (size_t rank = tie->last; rank > tie->first; --rank) {
      inner += risk / static_cast<double>(rank);
      mean_inner += inner / count;
    }
    for (size_t i = tie->first; i < tie->last; ++i) {
      const double loss = losses[order[i]], own = loss * tie->weight;
      ranked.influences[order[i]] = (own - later - mean_inner - ranked.area + ranked.mean) / n;
      ranked.mean_influences[order[i]] = (loss - ranked.mean) / n;
    }
    later += inner;
  }
  return ranked;
}

}  // namespace rcme
