#include "estimator/model_choice/criteria.h"

#include <algorithm>
#include <cmath>

#include "stats/distributions.h"

namespace rcme {
namespace {

constexpr double kPlunderSignificance = 0.05;

// sum rho(e^2) + n d cost_of_coordinate + k cost_of_parameter.
double PenalisedSum(std::span<const double> squared_residuals, const ModelDimensions& model,
                    double cost_of_coordinate, double cost_of_parameter) {
  const double bound = 2.0 * model.codimension();
  double score = cost_of_parameter * model.parameters;
  for (const double e2 : squared_residuals)
    score += std::min(e2, bound) + cost_of_coordinate * model.manifold;
  return score;
}

}  // namespace

double AicScore(std::span<const double> squared_residuals, const ModelDimensions& model) {
  return PenalisedSum(squared_residuals, model, 0.0, 2.0);
}

double GicScore(std::span<const double> squared_residuals, const ModelDimensions& model) {
  return PenalisedSum(squared_residuals, model, 2.0, 2.0);
}

double GricScore(std::span<const double> squared_residuals, const ModelDimensions& model) {
  const double n = std::max(1.0, static_cast<double>(squared_residuals.size()));
  return PenalisedSum(squared_residuals, model, std::log(kDimensionOfMatch), std::log(kDimensionOfMatch * n));
}

double PlunderDlScore(std::span<const double> squared_residuals, const ModelDimensions& model) {
  const double bound = ChiSquareQuantile(model.codimension(), 1.0 - kPlunderSignificance);
  const auto num_inliers = std::ranges::count_if(squared_residuals, [&](double e2) { return e2 <= bound; });
  const std::ptrdiff_t num_outliers = std::ssize(squared_residuals) - num_inliers;
  return static_cast<double>(model.manifold * num_inliers + kDimensionOfMatch * num_outliers +
                             model.parameters);
}

}  // namespace rcme
