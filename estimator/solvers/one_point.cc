#include "estimator/solvers/one_point.h"

#include <cmath>

namespace rcme {
namespace {

Eigen::Matrix3d MakeEssential(double cos_h, double sin_h) {
  Eigen::Matrix3d E;
  E << 0.0, cos_h, 0.0, -cos_h, 0.0, sin_h, 0.0, sin_h, 0.0;
  return E;
}

}  // namespace

// f of one match (eq::model_instantiate).
ModelList<OnePoint::Model, OnePoint::kMaxModels> OnePoint::FindModels(const Rays& rays1, const Rays& rays2) {
  ModelList<Model, kMaxModels> models;
  const Eigen::Vector3d &a = rays1[0], &b = rays2[0];
  // g = cos h * of_cos + sin h * of_sin vanishes at (cos h, sin h) = +-(of_sin, -of_cos) / length.
  const double of_cos = b.x() * a.y() - a.x() * b.y(), of_sin = a.y() + b.y();
  const double length = std::hypot(of_cos, of_sin);
  if (!(length > 1e-9 * a.norm() * b.norm()) || !std::isfinite(length)) return models;
  const double sign = of_sin < 0.0 ? -1.0 : 1.0;
  const double cos_h = sign * of_sin / length, sin_h = -sign * of_cos / length;

  const Vector9d T = Vectorize(MakeEssential(-sin_h, cos_h)) / std::sqrt(2.0);  // df/dh
  if (const auto G = ImplicitGain<1>(ConstraintRows(rays1, rays2), T)) {
    models.Add({Vectorize(MakeEssential(cos_h, sin_h)) / std::sqrt(2.0), *G});
  }
  return models;
}

}  // namespace rcme
