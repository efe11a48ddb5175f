#include "estimator/solvers/eight_point_svd.h"

#include <Eigen/SVD>

namespace rcme {

// f of eight matches (eq::model_instantiate).
ModelList<EightPointSvd::Model, EightPointSvd::kMaxModels> EightPointSvd::FindModels(const Rays& rays1,
                                                                                     const Rays& rays2) {
  using Rows = Eigen::Matrix<double, 8, 9>;
  ModelList<Model, kMaxModels> models;
  const Rows M = ConstraintRows(rays1, rays2);
  if (!M.allFinite()) return models;
  const Eigen::JacobiSVD<Rows> svd(M, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix<double, 8, 1>& s = svd.singularValues();
  if (!(s(7) > 1e-9 * s(0))) return models;
  Model model;
  model.f = svd.matrixV().col(8);
  model.G = svd.matrixV().leftCols<8>() * s.cwiseInverse().asDiagonal() * svd.matrixU().transpose();
  models.Add(model);
  return models;
}

}  // namespace rcme
