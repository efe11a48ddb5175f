#include "stats/paired.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>

#include "stats/confidence_sequence.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

// z(d), decreasing in d.
double TangoScore(double first_only, double second_only, double n, double d) {
  // q is the larger root of A q^2 + B q + C.
  const double A = 2.0 * n;
  const double B = -first_only - second_only + (2.0 * n - first_only + second_only) * d;
  const double C = -second_only * d * (1.0 - d);
  const double q = (std::sqrt(std::max(0.0, B * B - 4.0 * A * C)) - B) / (2.0 * A);
  const double variance = n * (2.0 * q + d * (1.0 - d));
  const double excess = first_only - second_only - n * d;
  if (variance > 0.0) return excess / std::sqrt(variance);
  return excess == 0.0 ? 0.0 : std::copysign(1e300, excess);
}

}  // namespace

void PairedCounts::Merge(const PairedCounts& other) {
  both += other.both;
  first_only += other.first_only;
  second_only += other.second_only;
  neither += other.neither;
}

double PairedCounts::RiskDifference() const {
  return static_cast<double>(first_only - second_only) / static_cast<double>(n());
}

double McNemarExactPValue(const PairedCounts& counts) {
  const std::int64_t discordant = counts.first_only + counts.second_only;
  if (discordant == 0) return 1.0;
  const boost::math::binomial law(static_cast<double>(discordant), 0.5);
  return std::min(1.0, 2.0 * cdf(law, static_cast<double>(std::min(counts.first_only, counts.second_only))));
}

double AnytimeMcNemarPValue(const PairedCounts& counts) {
  const std::int64_t discordant = counts.first_only + counts.second_only;
  return std::min(1.0, std::exp(-LogMixtureLikelihoodRatio(counts.first_only, discordant, 0.5)));
}

Interval RiskDifferenceInterval(const PairedCounts& counts, double confidence) {
  if (counts.n() <= 0) return {-1.0, 1.0};
  const double z = NormalQuantile(0.5 * (1.0 + confidence));
  const double n = static_cast<double>(counts.n());
  const double b = static_cast<double>(counts.first_only), c = static_cast<double>(counts.second_only);
  const auto end = [&](double outside, double sign) {
    double inside = counts.RiskDifference();
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (inside + outside);
      (sign * TangoScore(b, c, n, middle) <= z ? inside : outside) = middle;
    }
    return outside;
  };
  return {end(-1.0, 1.0), end(1.0, -1.0)};
}

}  // namespace rcme
