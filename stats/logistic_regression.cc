#include "stats/logistic_regression.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace rcme {
namespace {

// The observations, with 1 for the intercept before their features, and their weights.
struct WeightedEvents {
  Eigen::MatrixXd X;  // (n + 2) x (m + 1)
  Eigen::VectorXd y, count;
};

WeightedEvents MakeEvents(std::span<const double> features, const std::vector<bool>& happened, size_t m) {
  const auto n = static_cast<Eigen::Index>(happened.size()), width = static_cast<Eigen::Index>(m);
  WeightedEvents events{Eigen::MatrixXd::Ones(n + 2, width + 1), Eigen::VectorXd::Zero(n + 2),
                        Eigen::VectorXd::Ones(n + 2)};
  for (Eigen::Index i = 0; i < n; ++i) {
    events.y(i) = happened[static_cast<size_t>(i)] ? 1.0 : 0.0;
    for (Eigen::Index j = 0; j < width; ++j)
      events.X(i, j + 1) = features[static_cast<size_t>(i * width + j)];
  }
  for (Eigen::Index j = 1; j <= width; ++j)
    events.X.col(j).tail(2).setConstant(events.X.col(j).head(n).mean());
  events.y(n) = 1.0;
  events.count.tail(2).setConstant(0.5);
  return events;
}

// -log likelihood of log odds eta, summed without overflow.
double Cost(const WeightedEvents& events, const Eigen::VectorXd& beta, const Eigen::VectorXd& centre,
            const Eigen::VectorXd& ridge) {
  const Eigen::ArrayXd eta = (events.X * beta).array();
  const Eigen::ArrayXd log1p = eta.max(0.0) + (-eta.abs()).exp().log1p();
  return (events.count.array() * (log1p - events.y.array() * eta)).sum() +
         0.5 * (ridge.array() * (beta - centre).array().square()).sum();
}

}  // namespace

LogisticFit FitLogistic(std::span<const double> features, const std::vector<bool>& happened,
                        std::span<const double> prior, double penalty) {
  const size_t m = prior.size();
  if (happened.empty() || features.size() != m * happened.size() || !(penalty > 0.0) ||
      !std::ranges::all_of(features, [](double x) { return std::isfinite(x); }))
    throw std::invalid_argument("a logistic fit needs finite features of every observation and a penalty");
  const WeightedEvents events = MakeEvents(features, happened, m);
  const auto size = static_cast<Eigen::Index>(m) + 1;
  Eigen::VectorXd centre = Eigen::VectorXd::Zero(size);
  centre.tail(size - 1) = Eigen::Map<const Eigen::VectorXd>(prior.data(), size - 1);
  Eigen::VectorXd ridge = Eigen::VectorXd::Constant(size, penalty);
  ridge(0) = 0.0;
  Eigen::VectorXd beta = centre;
  double cost = Cost(events, beta, centre, ridge);
  for (int iteration = 0; iteration < 100; ++iteration) {
    const Eigen::ArrayXd mean = 1.0 / (1.0 + (-(events.X * beta).array()).exp());
    const Eigen::VectorXd slope =
        events.X.transpose() * (events.count.array() * (mean - events.y.array())).matrix() +
        ridge.cwiseProduct(beta - centre);
    const Eigen::VectorXd curvature = events.count.array() * mean * (1.0 - mean);
    Eigen::MatrixXd H = events.X.transpose() * curvature.asDiagonal() * events.X;
    H.diagonal() += ridge;
    H(0, 0) += 1e-9;  // all means at 0 or 1
    Eigen::VectorXd step = H.ldlt().solve(slope);
    double next = Cost(events, beta - step, centre, ridge);
    for (int halving = 0; halving < 30 && !(next <= cost); ++halving) {
      step *= 0.5;
      next = Cost(events, beta - step, centre, ridge);
    }
    if (!(next <= cost)) break;
    beta -= step;
    const double gain = cost - next;
    cost = next;
    if (gain <= 1e-12 * (1.0 + std::abs(cost))) break;
  }
  LogisticFit fit{beta(0), {}};
  for (Eigen::Index j = 1; j < size; ++j) fit.weights.push_back(beta(j));
  return fit;
}

}  // namespace rcme
