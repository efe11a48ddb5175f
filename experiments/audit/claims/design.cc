#include "experiments/audit/claims/design.h"

#include <algorithm>

#include "stats/distributions.h"

namespace rcme {

Interval AllowedRate(double nominal, double margin) {
  return {std::max(0.0, nominal - margin), std::min(1.0, nominal + margin)};
}

Interval CoverageWithin(int degrees_of_freedom, double significance_level, double tolerance) {
  const double quantile = ChiSquareQuantile(degrees_of_freedom, 1.0 - significance_level);
  const double ratio = (1.0 + tolerance) * (1.0 + tolerance);
  return {ChiSquareCdf(degrees_of_freedom, quantile / ratio),
          ChiSquareCdf(degrees_of_freedom, quantile * ratio)};
}

Interval MeanPitWithin(int degrees_of_freedom, double tolerance) {
  const double ratio = (1.0 + tolerance) * (1.0 + tolerance);
  return {FisherCdf(degrees_of_freedom, degrees_of_freedom, 1.0 / ratio),
          FisherCdf(degrees_of_freedom, degrees_of_freedom, ratio)};
}

Target PlannedRate(const std::string& quantity, double nominal, const CheckDesign& design, size_t statistic) {
  Target target = ClaimedRate(quantity, nominal, AllowedRate(nominal, design.margin), statistic);
  target.planned_share = design.share;
  return target;
}

Target PlannedMean(const std::string& quantity, double nominal, const CheckDesign& design, size_t statistic) {
  Target target = ClaimedMean(quantity, nominal, Around(nominal, design.margin), statistic);
  target.planned_share = design.share;
  target.planned_spread = design.spread;
  return target;
}

Target PlannedBoundedMean(const std::string& quantity, double nominal, const Interval& allowed,
                          const Interval& range, const CheckDesign& design, size_t statistic) {
  Target target = PlannedMean(quantity, nominal, design, statistic);
  target.kind = Target::Kind::kBoundedMean;
  target.allowed = allowed;
  target.range = range;
  return target;
}

}  // namespace rcme
