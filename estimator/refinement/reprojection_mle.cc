#include "estimator/refinement/reprojection_mle.h"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <vector>

#include "estimator/geometry/sampson.h"
#include "estimator/geometry/triangulation.h"
#include "estimator/noise_scale.h"

namespace rcme {
namespace {

constexpr int kPoseSize = 12;  // R column by column, then t
constexpr int kPointSize = 3;  // u, v (ray in camera 1), inverse depth in baselines

using RowMajorPlusJacobian = Eigen::Matrix<double, kPoseSize, 5, Eigen::RowMajor>;

RelativePose PoseFromBlock(const double* block) {
  return {Eigen::Map<const Eigen::Matrix3d>(block), Eigen::Map<const Eigen::Vector3d>(block + 9)};
}

void WriteBlock(const RelativePose& pose, double* block) {
  Eigen::Map<Eigen::Matrix3d> R(block);
  Eigen::Map<Eigen::Vector3d> t(block + 9);
  R = pose.R;
  t = pose.t;
}

// d(pose block)/d(tangent) at zero: dR/dw_k = [e_k]x R, dt/db = B.
RowMajorPlusJacobian PlusJacobianAt(const RelativePose& pose) {
  RowMajorPlusJacobian jacobian = RowMajorPlusJacobian::Zero();
  for (int k = 0; k < 3; ++k) {
    const Eigen::Matrix3d dR = CrossMatrix(Eigen::Vector3d::Unit(k)) * pose.R;
    jacobian.block<9, 1>(0, k) = Eigen::Map<const Vector9d>(dR.data());
  }
  jacobian.block<3, 2>(9, 3) = DirectionBasis(pose.t);
  return jacobian;
}

// The 5-dimensional manifold of two-view motions with Retract (geometry/pose.h).
class MotionManifold : public ceres::Manifold {
 public:
  int AmbientSize() const override { return kPoseSize; }
  int TangentSize() const override { return 5; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override {
    WriteBlock(Retract(PoseFromBlock(x), Eigen::Map<const Vector5d>(delta)), x_plus_delta);
    return true;
  }
  bool PlusJacobian(const double* x, double* jacobian) const override {
    Eigen::Map<RowMajorPlusJacobian>(jacobian, kPoseSize, 5) = PlusJacobianAt(PoseFromBlock(x));
    return true;
  }
  bool Minus(const double* y, const double* x, double* y_minus_x) const override {
    Eigen::Map<Vector5d>(y_minus_x, 5) = LocalCoordinates(PoseFromBlock(x), PoseFromBlock(y));
    return true;
  }
  bool MinusJacobian(const double* x, double* jacobian) const override {
    const RowMajorPlusJacobian plus = PlusJacobianAt(PoseFromBlock(x));
    Eigen::Map<Eigen::Matrix<double, 5, kPoseSize, Eigen::RowMajor>>(jacobian, 5, kPoseSize) =
        (plus.transpose() * plus).ldlt().solve(plus.transpose());
    return true;
  }
};

// Reprojection error of one match in both images, 4 residuals in units of sigma.
struct ReprojectionError {
  Correspondence match;
  Camera camera1, camera2;
  double inverse_sigma;

  template <typename T>
  bool operator()(const T* pose, const T* point, T* residuals) const {
    const Eigen::Map<const Eigen::Matrix<T, 3, 3>> R(pose);
    const Eigen::Map<const Eigen::Matrix<T, 3, 1>> t(pose + 9);
    const Eigen::Matrix<T, 3, 1> ray1(point[0], point[1], T(1.0));
    const Eigen::Matrix<T, 3, 1> in_cam2 = R * ray1 + point[2] * t;  // the point times its inverse depth
    residuals[0] = inverse_sigma * (camera1.fx * ray1.x() + camera1.cx - match.x1_px.x());
    residuals[1] = inverse_sigma * (camera1.fy * ray1.y() + camera1.cy - match.x1_px.y());
    residuals[2] = inverse_sigma * (camera2.fx * in_cam2.x() / in_cam2.z() + camera2.cx - match.x2_px.x());
    residuals[3] = inverse_sigma * (camera2.fy * in_cam2.y() / in_cam2.z() + camera2.cy - match.x2_px.y());
    return true;
  }
};

using ReprojectionCost = ceres::AutoDiffCostFunction<ReprojectionError, 4, kPoseSize, kPointSize>;

// The start value of a point: the triangulated Sampson-corrected match.
Eigen::Vector3d InitialPoint(const MotionProblem& problem, const Correspondence& match,
                             const RelativePose& pose, const Eigen::Matrix3d& F) {
  const Eigen::Vector4d correction = SampsonVector(F, match);
  const Eigen::Vector3d ray1 = problem.camera1.Ray(match.x1_px + correction.head<2>());
  const Eigen::Vector3d ray2 = problem.camera2.Ray(match.x2_px + correction.tail<2>());
  return {ray1.x(), ray1.y(), InverseDepth(pose, ray1, ray2)};
}

// The unit vector normal to three columns, up to its sign: the signed minors, as a cross product in four
// dimensions.
Eigen::Vector4d NormalToColumns(const Eigen::Matrix<double, 4, kPointSize, Eigen::RowMajor>& columns) {
  Eigen::Vector4d normal;
  for (int i = 0; i < 4; ++i) {
    Eigen::Matrix3d minor;
    for (int row = 0; row < 3; ++row) minor.row(row) = columns.row(row < i ? row : row + 1);
    normal(i) = (i % 2 == 0 ? 1.0 : -1.0) * minor.determinant();
  }
  return normal.normalized();
}

// One match's share of the Fisher information of the motion with its point marginalised. Of the four
// residuals three determine the point; the one normal to them informs about the motion.
Matrix5d MarginalInformation(const ReprojectionCost& cost, const double* pose, const double* point) {
  Eigen::Matrix<double, 4, kPoseSize, Eigen::RowMajor> d_pose;
  Eigen::Matrix<double, 4, kPointSize, Eigen::RowMajor> d_point;
  Eigen::Vector4d residuals;
  const double* parameters[] = {pose, point};
  double* jacobians[] = {d_pose.data(), d_point.data()};
  cost.Evaluate(parameters, residuals.data(), jacobians);
  const Eigen::Matrix<double, 1, 5> row =
      NormalToColumns(d_point).transpose() * d_pose * PlusJacobianAt(PoseFromBlock(pose));
  return row.transpose() * row;
}

}  // namespace

RefinedMotion RefineByReprojection(const MotionProblem& problem, std::span<const int> indices,
                                   const RelativePose& start, Loss loss, double function_tolerance) {
  RefinedMotion refined;
  refined.cam2_from_cam1 = start;
  if (indices.size() < 5) return refined;

  std::array<double, kPoseSize> pose{};
  WriteBlock(start, pose.data());
  std::vector<Eigen::Vector3d> points;
  std::vector<const ReprojectionCost*> costs;
  points.reserve(indices.size());
  costs.reserve(indices.size());
  const Eigen::Matrix3d F =
      FundamentalFromEssential(EssentialFromPose(start), problem.camera1, problem.camera2);

  ceres::Problem bundle;
  auto* ordering = new ceres::ParameterBlockOrdering;
  for (const int index : indices) {
    const Correspondence& match = problem.matches[static_cast<size_t>(index)];
    points.push_back(InitialPoint(problem, match, start, F));
    const double sigma_px = problem.sigma_px * NoiseScaleAt(problem, static_cast<size_t>(index));
    auto* cost =
        new ReprojectionCost(new ReprojectionError{match, problem.camera1, problem.camera2, 1.0 / sigma_px});
    costs.push_back(cost);
    bundle.AddResidualBlock(cost, loss == Loss::kCauchy ? new ceres::CauchyLoss(kCauchyScale) : nullptr,
                            pose.data(), points.back().data());
    ordering->AddElementToGroup(points.back().data(), 0);
  }
  bundle.SetManifold(pose.data(), new MotionManifold);
  ordering->AddElementToGroup(pose.data(), 1);

  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.linear_solver_ordering.reset(ordering);
  options.max_num_iterations = 100;
  options.function_tolerance = function_tolerance;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &bundle, &summary);
  refined.num_iterations = static_cast<int>(summary.iterations.size());
  const RelativePose optimum = PoseFromBlock(pose.data());
  if (!summary.IsSolutionUsable() || !optimum.R.allFinite() || !optimum.t.allFinite()) return refined;

  Matrix5d information = Matrix5d::Zero();
  for (size_t k = 0; k < costs.size(); ++k) {
    information += MarginalInformation(*costs[k], pose.data(), points[k].data());
  }
  const Eigen::LLT<Matrix5d> llt(information);
  if (llt.info() != Eigen::Success) return refined;
  refined.pose_cov = llt.solve(Matrix5d::Identity());
  if (!refined.pose_cov.allFinite()) return refined;
  refined.cam2_from_cam1 = optimum;
  refined.converged = true;
  return refined;
}

}  // namespace rcme
