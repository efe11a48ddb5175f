#include "simulator/outlier_model.h"

#include <fmt/format.h>

#include <cmath>

#include "parameters/input_error.h"
#include "simulator/outliers/outlier_laws.h"
#include "stats/tilted_binomial.h"

namespace rcme {

OutlierModel::OutlierModel(double ratio) : OutlierModel(MakeUniformOutliers(), ratio) {}

OutlierModel::Drawn OutlierModel::DrawCount(int num_matches, RandomStream& rng) const {
  const bool is_tilted = !std::isnan(tilted_to);
  if (count == Count::kExact) {
    if (is_tilted) {
      throw InputError(fmt::format(
          "tilted_to: {} is not allowed with outlier_count: exact; give none, or outlier_count: bernoulli",
          tilted_to));
    }
    return {static_cast<int>(std::lround(outlier_ratio * num_matches)), 1.0};
  }
  const double ratio = is_tilted ? rng.Uniform(outlier_ratio, tilted_to) : outlier_ratio;
  Drawn drawn;
  for (int i = 0; i < num_matches; ++i) drawn.num_outliers += rng.Uniform() < ratio;
  if (is_tilted)
    drawn.weight = TiltedBinomialWeight(drawn.num_outliers, num_matches, outlier_ratio, tilted_to);
  return drawn;
}

std::vector<Parameter> Parameters(OutlierModel& outliers) {
  std::vector<Parameter> all = {
      Parameter::Real("outlier_ratio", &outliers.outlier_ratio, {0.0, 1.0}, "", "share of wrong matches"),
      Parameter::Choice<OutlierModel::Count>(
          "outlier_count", &outliers.count,
          {{"exact", OutlierModel::Count::kExact}, {"bernoulli", OutlierModel::Count::kBernoulli}},
          "exact: the share to one match; bernoulli: each match with that probability"),
      Parameter::RealOrWord(
          "tilted_to", &outliers.tilted_to, {0.0, 1.0}, "none", "",
          "with bernoulli: importance sampling of the number of wrong matches, by shares from "
          "outlier_ratio to this")};
  const std::vector<Parameter> more = outliers.law->Parameters();
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace rcme
