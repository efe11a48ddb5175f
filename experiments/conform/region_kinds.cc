#include "experiments/conform/region_kinds.h"

#include <algorithm>
#include <cmath>

#include "stats/constants.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

double ComputeRegionSize(const JudgedAnswer& answer, double factor) {
  const double radius = std::sqrt(factor * ChiSquareQuantile(5, answer.level));
  const double size_deg = kDegPerRad * radius * std::exp(answer.row.log_det / 10.0);
  return std::isfinite(factor) ? std::min(size_deg, kWholeSpaceDeg) : kWholeSpaceDeg;
}

RegionKind RegionOfFactor(const std::string& name, const std::function<double(const JudgedAnswer&)>& factor) {
  return {name,
          [factor](const JudgedAnswer& a) { return a.row.nees <= factor(a) * ChiSquareQuantile(5, a.level); },
          [factor](const JudgedAnswer& a) { return ComputeRegionSize(a, factor(a)); }};
}

}  // namespace

std::vector<RegionKind> ListRegionKinds(bool is_check) {
  std::vector<RegionKind> kinds = {RegionOfFactor("stated", [](const JudgedAnswer&) { return 1.0; })};
  if (!is_check) {
    kinds.push_back({"one bound", [](const JudgedAnswer& a) { return a.row.max_error_deg <= a.ball_deg; },
                     [](const JudgedAnswer& a) { return std::min(a.ball_deg, kWholeSpaceDeg); }});
    kinds.push_back(RegionOfFactor("one factor", [](const JudgedAnswer& a) { return a.one_factor; }));
  }
  kinds.push_back(RegionOfFactor("conformed", [](const JudgedAnswer& a) { return a.verdict.factor; }));
  return kinds;
}

}  // namespace rcme
