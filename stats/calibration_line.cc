#include "stats/calibration_line.h"

#include <cmath>
#include <optional>
#include <vector>

#include "stats/constants.h"

namespace rcme {
namespace {

struct Line {
  double intercept = 0.0, slope = 0.0;
};

// log(1 + exp(x)) without overflow.
double SoftPlus(double x) { return x > 0.0 ? x + std::log1p(std::exp(-x)) : std::log1p(std::exp(x)); }

// Log-likelihood of a line with its gradient g and the negative second derivative H = [h00 h01; h01 h11].
struct Likelihood {
  double value = 0.0, g0 = 0.0, g1 = 0.0, h00 = 0.0, h01 = 0.0, h11 = 0.0;

  Likelihood(const std::vector<double>& log_odds, std::span<const Forecast> forecasts, const Line& line) {
    for (size_t i = 0; i < log_odds.size(); ++i) {
      const double x = log_odds[i], y = forecasts[i].happened ? 1.0 : 0.0;
      const double eta = line.intercept + line.slope * x, mu = 1.0 / (1.0 + std::exp(-eta));
      value += y * eta - SoftPlus(eta);
      g0 += y - mu;
      g1 += (y - mu) * x;
      const double w = mu * (1.0 - mu);
      h00 += w, h01 += w * x, h11 += w * x * x;
    }
  }
  double determinant() const { return h00 * h11 - h01 * h01; }
  bool IsRegular() const { return determinant() > 1e-10 * h00 * h11; }
  // H^-1 (a, b).
  Line Solve(double a, double b) const {
    return {(h11 * a - h01 * b) / determinant(), (h00 * b - h01 * a) / determinant()};
  }
};

// Newton's method; steps are halved until the likelihood, which is concave, does not fall.
std::optional<Line> MostLikelyLine(const std::vector<double>& log_odds, std::span<const Forecast> forecasts) {
  Line line = {0.0, 1.0};
  Likelihood now(log_odds, forecasts, line);
  for (int iteration = 0; iteration < 60; ++iteration) {
    if (!now.IsRegular()) return std::nullopt;
    Line step = now.Solve(now.g0, now.g1);
    if (std::abs(step.intercept) < 1e-9 && std::abs(step.slope) < 1e-9) return line;
    for (int halving = 0; halving < 40; ++halving) {
      const Line next = {line.intercept + step.intercept, line.slope + step.slope};
      const Likelihood there(log_odds, forecasts, next);
      if (there.value >= now.value - 1e-9) {
        line = next, now = there;
        break;
      }
      step.intercept *= 0.5, step.slope *= 0.5;
    }
  }
  return std::nullopt;  // perfect separation: the slope grows without bound
}

}  // namespace

CalibrationLine FitCalibrationLine(std::span<const Forecast> forecasts) {
  CheckForecasts(forecasts);
  std::vector<double> log_odds;
  for (const Forecast& forecast : forecasts) {
    const double p = ClippedProbability(forecast.probability);
    log_odds.push_back(std::log(p) - std::log1p(-p));
  }
  const std::vector<std::int64_t> clusters = ListClusters(forecasts);
  const std::optional<Line> line = MostLikelyLine(log_odds, forecasts);
  CalibrationLine result;
  if (!line) {
    result.intercept = {kNaN, kNaN, {-kInfinity, kInfinity}, std::ssize(forecasts), 0};
    result.slope = result.intercept;
    return result;
  }
  const Likelihood at_optimum(log_odds, forecasts, *line);
  std::vector<double> of_intercept, of_slope;
  for (size_t i = 0; i < forecasts.size(); ++i) {
    const double mu = 1.0 / (1.0 + std::exp(-line->intercept - line->slope * log_odds[i]));
    const double miss = (forecasts[i].happened ? 1.0 : 0.0) - mu;
    const Line influence = at_optimum.Solve(miss, miss * log_odds[i]);
    of_intercept.push_back(influence.intercept);
    of_slope.push_back(influence.slope);
  }
  result.intercept = EstimateFromInfluences(line->intercept, of_intercept, clusters);
  result.slope = EstimateFromInfluences(line->slope, of_slope, clusters);
  return result;
}

}  // namespace rcme
