#include "simulator/outlier_model.h"

#include <cmath>

#include "simulator/outliers/outlier_laws.h"

namespace rcme {

OutlierModel::OutlierModel(double ratio) : OutlierModel(MakeUniformOutliers(), ratio) {}

OutlierModel::Drawn OutlierModel::DrawCount(int num_matches, RandomStream& rng) const {
  if (count == Count::kExact) return {static_cast<int>(std::lround(outlier_ratio * num_matches)), 1.0};
  Drawn drawn;
  for (int i = 0; i < num_matches; ++i) drawn.num_outliers += rng.Uniform() < outlier_ratio;
  return drawn;
}

std::vector<Parameter> Parameters(OutlierModel& outliers) {
  std::vector<Parameter> all = {
      Parameter::Real("outlier_ratio", &outliers.outlier_ratio, {0.0, 1.0}, "", "share of wrong matches"),
      Parameter::Choice<OutlierModel::Count>(
          "outlier_count", &outliers.count,
          {{"exact", OutlierModel::Count::kExact}, {"bernoulli", OutlierModel::Count::kBernoulli}},
          "exact: the share to one match; bernoulli: each match is wrong with that probability")};
  const std::vector<Parameter> more = outliers.law->Parameters();
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace rcme
