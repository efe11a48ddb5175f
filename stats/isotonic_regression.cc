#include "stats/isotonic_regression.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace rcme {
namespace {

// Neighbouring points with a common fitted value.
struct Block {
  double sum = 0.0, weight = 0.0;
  size_t count = 0;
  double mean() const { return sum / weight; }
};

}  // namespace

std::vector<double> PoolAdjacentViolators(std::span<const double> values, std::span<const double> weights) {
  if (values.size() != weights.size())
    throw std::invalid_argument("isotonic regression: not as many weights as values");
  std::vector<Block> blocks;
  for (size_t i = 0; i < values.size(); ++i) {
    if (!(weights[i] > 0.0)) throw std::invalid_argument("isotonic regression: a weight is not above 0");
    Block last = {values[i] * weights[i], weights[i], 1};
    while (!blocks.empty() && blocks.back().mean() >= last.mean()) {
      last = {last.sum + blocks.back().sum, last.weight + blocks.back().weight,
              last.count + blocks.back().count};
      blocks.pop_back();
    }
    blocks.push_back(last);
  }
  std::vector<double> fitted;
  fitted.reserve(values.size());
  for (const Block& block : blocks) fitted.insert(fitted.end(), block.count, block.mean());
  return fitted;
}

double IsotonicFit::At(double at) const {
  if (x.empty() || std::isnan(at)) throw std::invalid_argument("isotonic regression: nothing to look up");
  const auto above = std::lower_bound(x.begin(), x.end(), at);  // the first point not below
  if (above == x.end()) return y.back();
  const auto i = static_cast<size_t>(above - x.begin());
  if (*above == at || i == 0) return y[i];
  const double share = (at - x[i - 1]) / (x[i] - x[i - 1]);
  return std::isfinite(share) ? y[i - 1] + share * (y[i] - y[i - 1]) : y[i - 1];
}

IsotonicFit FitIsotonic(std::span<const double> x, std::span<const double> y) {
  if (x.empty() || x.size() != y.size())
    throw std::invalid_argument("isotonic regression: no points, or not as many of x and y");
  std::vector<size_t> order(x.size());
  std::iota(order.begin(), order.end(), size_t{0});
  for (size_t i = 0; i < x.size(); ++i) {
    if (std::isnan(x[i]) || std::isnan(y[i])) throw std::invalid_argument("isotonic regression: a NaN");
  }
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return x[a] < x[b]; });
  IsotonicFit fit;
  std::vector<double> means, counts;
  for (const size_t i : order) {
    if (fit.x.empty() || fit.x.back() != x[i]) {
      fit.x.push_back(x[i]);
      means.push_back(0.0);
      counts.push_back(0.0);
    }
    counts.back() += 1.0;
    means.back() += (y[i] - means.back()) / counts.back();
  }
  fit.y = PoolAdjacentViolators(means, counts);
  return fit;
}

}  // namespace rcme
