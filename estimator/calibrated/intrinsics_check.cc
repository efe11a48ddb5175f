#include "estimator/calibrated/intrinsics_check.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "estimator/geometry/essential_matrix.h"
#include "estimator/noise_scale.h"

namespace rcme {
namespace {

// Root mean squares over the population documented_ranges (studies/any_condition.yaml): of ln f, c_x and c_y
// in px, k1.
constexpr double kFocalSd = 0.014, kPrincipalPointSdPx = 4.7, kDistortionSd = 0.023;
constexpr Eigen::Index kOfCamera = 4;

using OfCamera = Eigen::Matrix<double, 1, kOfCamera>;

// Change of line'x with each error of usual size, where x is a point of the image plane z = 1.
OfCamera MoveAlong(const Eigen::Vector2d& line, const Eigen::Vector2d& x, const Eigen::Array2d& per_focal) {
  const double along = line.dot(x);
  return {-kFocalSd * along, -kPrincipalPointSdPx * per_focal.x() * line.x(),
          -kPrincipalPointSdPx * per_focal.y() * line.y(), -kDistortionSd * x.squaredNorm() * along};
}

// How a point x of the image plane z = 1 moves with each error of usual size of one camera.
class PointMoves {
 public:
  PointMoves(const MotionProblem& problem, Camera MotionProblem::*camera, Lens Undistortion::*lens,
             const Eigen::Matrix2d& of_pixels)
      : per_focal_of_pixels_(
            Eigen::Vector2d(1.0 / (problem.*camera).fx, 1.0 / (problem.*camera).fy).asDiagonal() *
            of_pixels) {
    if (!problem.undistortion) return;
    lens_ = (*problem.undistortion).*lens;
    turn_ = per_focal_of_pixels_ * Eigen::Vector2d(lens_->camera.fx, lens_->camera.fy).asDiagonal();
  }

  Eigen::Matrix<double, 2, kOfCamera> At(const Eigen::Vector2d& x) const {
    if (lens_) return MoveThroughLens(x);
    Eigen::Matrix<double, 2, kOfCamera> moves;
    moves << -kFocalSd * x, -kPrincipalPointSdPx * per_focal_of_pixels_, -kDistortionSd * x.squaredNorm() * x;
    return moves;
  }

 private:
  // The pixel u(x; lens) stays: dx = -(du/dx)^-1 du/dlens dlens. u is linear in k1. Turned pixels have a
  // turned x.
  Eigen::Matrix<double, 2, kOfCamera> MoveThroughLens(const Eigen::Vector2d& x) const {
    const Eigen::Vector2d ray = turn_.transpose() * x, u_px = ProjectThrough(*lens_, ray);
    Lens other = *lens_;
    if (other.model == LensModel::kPinhole) other.model = LensModel::kRadtan;
    other.k[0] += kDistortionSd;
    Eigen::Matrix<double, 2, kOfCamera> of_pixel;
    of_pixel << kFocalSd * (u_px - Eigen::Vector2d(lens_->camera.cx, lens_->camera.cy)),
        kPrincipalPointSdPx * Eigen::Matrix2d::Identity(), ProjectThrough(other, ray) - u_px;
    return -turn_ * ProjectThroughJacobian(*lens_, ray).inverse() * of_pixel;
  }

  Eigen::Matrix2d per_focal_of_pixels_;
  std::optional<Lens> lens_;
  Eigen::Matrix2d turn_ = Eigen::Matrix2d::Identity();  // from rays of the lens to those of the problem
};

struct ExactMoves {
  PointMoves image1, image2;
};

// The derivatives of the residuals by the errors of either camera. `exact`: null for CheckIntrinsics.
class ResidualErrors {
 public:
  ResidualErrors(const MotionProblem& problem, const RelativePose& pose, const ExactMoves* exact)
      : problem_(problem),
        exact_(exact),
        E_(EssentialFromPose(pose)),
        per_focal1_(1.0 / problem.camera1.fx, 1.0 / problem.camera1.fy),
        per_focal2_(1.0 / problem.camera2.fx, 1.0 / problem.camera2.fy) {}

  struct OfMatch {
    OfCamera by_camera1, by_camera2;
  };
  // The residual is g / sqrt(N) with g = ray2' E ray1 and N the variance of g by noise of 1 px. Its
  // derivative is (dg - g / N dN / 2) / sqrt(N). N changes as the epipolar lines move with the points, and as
  // a greater focal length lessens the noise of a ray.
  OfMatch Differentiate(size_t i) const {
    const Eigen::Vector3d ray1 = problem_.camera1.Ray(problem_.matches[i].x1_px),
                          ray2 = problem_.camera2.Ray(problem_.matches[i].x2_px);
    const Eigen::Vector2d line1 = E_.leftCols<2>().transpose() * ray2, line2 = E_.topRows<2>() * ray1;
    // dN / dline / 2
    const Eigen::Vector2d by_line1 = per_focal1_.square() * line1.array(),
                          by_line2 = per_focal2_.square() * line2.array();
    const double variance1 = line1.dot(by_line1), variance2 = line2.dot(by_line2);
    const double per_root = 1.0 / std::sqrt(variance1 + variance2);
    const double g_over_variance = (ray2.head<2>().dot(line2) + E_.row(2).dot(ray1)) * per_root * per_root;
    const Eigen::Matrix2d E = E_.topLeftCorner<2, 2>();
    const Eigen::Vector2d by_x1 = per_root * (line1 - g_over_variance * (E.transpose() * by_line2)),
                          by_x2 = per_root * (line2 - g_over_variance * (E * by_line1));
    OfMatch of;
    if (exact_ != nullptr) {
      of = {by_x1.transpose() * exact_->image1.At(ray1.head<2>()),
            by_x2.transpose() * exact_->image2.At(ray2.head<2>())};
    } else {
      of = {MoveAlong(by_x1, ray1.head<2>(), per_focal1_), MoveAlong(by_x2, ray2.head<2>(), per_focal2_)};
    }
    of.by_camera1(0) += per_root * g_over_variance * kFocalSd * variance1;
    of.by_camera2(0) += per_root * g_over_variance * kFocalSd * variance2;
    return of;
  }

 private:
  const MotionProblem& problem_;
  const ExactMoves* exact_;
  Eigen::Matrix3d E_;
  Eigen::Array2d per_focal1_, per_focal2_;  // 1 / px
};

// [J, G, r]' W [J, G, r], summed over the matches that the answer explains.
template <Eigen::Index kErrors>
Eigen::Matrix<double, 6 + kErrors, 6 + kErrors> SumProducts(const MotionProblem& problem, const Mode& answer,
                                                            const Explanation& e, const ExactMoves* exact) {
  const ResidualErrors errors(problem, answer.pose, exact);
  const MixtureParameters& m = answer.mixture;
  Eigen::Matrix<double, 6 + kErrors, 6 + kErrors> sums;
  sums.setZero();
  for (size_t i = 0; i < e.probability.size(); ++i) {
    if (!(e.probability[i] > 0.5)) continue;
    const auto [by_camera1, by_camera2] = errors.Differentiate(i);
    Eigen::Matrix<double, 6 + kErrors, 1> row;
    for (size_t k = 0; k < 5; ++k) row(static_cast<Eigen::Index>(k)) = e.terms.derivative[k][i];
    const double per_sd = 1.0 / (problem.sigma_px * NoiseScaleAt(problem, i));
    if constexpr (kErrors == kOfCamera) {
      row.template segment<kErrors>(5) = per_sd * (by_camera1 + by_camera2).transpose();
    } else {
      row.template segment<kErrors>(5) << per_sd * by_camera1.transpose(), per_sd * by_camera2.transpose();
    }
    row(5 + kErrors) = e.terms.residual[i];
    if (!row.allFinite()) continue;
    const double weight = e.probability[i] * NoiseWeight(m.noise, e.terms.residual[i] / m.scale);
    sums.noalias() += row * (weight * row).transpose();
  }
  return sums / (m.scale * m.scale);
}

constexpr double kLeastInformation = 0.7;  // U, 1 / rad^2
constexpr double kLeastRad = 1e-5, kMostRad = 3.0, kMostGain = 30.0;

template <Eigen::Index kErrors>
struct Evidence {
  Eigen::Matrix<double, kErrors, kErrors> information;  // I_theta
  Eigen::Matrix<double, kErrors, 1> score;              // q
  Eigen::Matrix<double, 5, kErrors> M;
};

template <Eigen::Index kErrors>
Evidence<kErrors> FindEvidence(const MotionProblem& problem, const Mode& answer, const Explanation& e,
                               const ExactMoves* exact) {
  const auto sums = SumProducts<kErrors>(problem, answer, e, exact);
  const Matrix5d of_motion = sums.template topLeftCorner<5, 5>();
  const auto across = sums.template block<kErrors, 5>(5, 0);
  const auto of_errors = sums.template block<kErrors, kErrors>(5, 5);
  const auto last = sums.template bottomRows<1>();
  const Eigen::Matrix<double, 5, kErrors> M =
      Eigen::LLT<Matrix5d>(Matrix5d(of_motion + kLeastInformation * Matrix5d::Identity()))
          .solve(Eigen::Matrix<double, 5, kErrors>(across.transpose()));
  return {of_errors - across * M,
          M.transpose() * last.template head<5>().transpose() - last.template segment<kErrors>(5).transpose(),
          M};
}

template <Eigen::Index kErrors>
IntrinsicsCheck Check(const MotionProblem& problem, const Mode& answer, const Explanation& e) {
  using Square = Eigen::Matrix<double, kErrors, kErrors>;
  const auto [information, score, M] = FindEvidence<kErrors>(problem, answer, e, nullptr);
  const Square V = (information + Square::Identity()).llt().solve(Square::Identity());
  const Eigen::Matrix<double, kErrors, 1> theta = V * score;
  const Eigen::Matrix<double, 2, kErrors> D = -M.template bottomRows<2>();
  // What is not a number is not known to be greater than the least.
  const auto root_within = [](double square, double least, double most) {
    return square > least * least ? std::min(std::sqrt(square), most) : least;
  };
  return {.reach_rad = root_within(D.squaredNorm(), kLeastRad, kMostRad),
          .root_gain = root_within(score.dot(theta), 0.0, kMostGain),
          .shift_rad = root_within((D * theta).squaredNorm(), kLeastRad, kMostRad)};
}

}  // namespace

IntrinsicsCheck CheckIntrinsics(const MotionProblem& problem, const Mode& answer,
                                const Explanation& explanation) {
  if (IsOfOneCamera(problem)) return Check<kOfCamera>(problem, answer, explanation);
  return Check<2 * kOfCamera>(problem, answer, explanation);
}

IntrinsicsEvidence FindIntrinsicsEvidence(const MotionProblem& problem, const Mode& answer,
                                          const Explanation& explanation, const CalibrationPrior& stated) {
  const ExactMoves exact{{problem, &MotionProblem::camera1, &Undistortion::lens1, stated.of_pixels1},
                         {problem, &MotionProblem::camera2, &Undistortion::lens2, stated.of_pixels2}};
  const Eigen::Vector4d of_camera(
      stated.focal_sd / kFocalSd, stated.principal_point_sd_px / kPrincipalPointSdPx,
      stated.principal_point_sd_px / kPrincipalPointSdPx, stated.distortion_sd / kDistortionSd);
  const auto find = [&]<Eigen::Index kErrors>() -> IntrinsicsEvidence {
    const Evidence<kErrors> evidence = FindEvidence<kErrors>(problem, answer, explanation, &exact);
    return {evidence.information, evidence.score, -evidence.M, of_camera.replicate<kErrors / kOfCamera, 1>()};
  };
  return IsOfOneCamera(problem) ? find.template operator()<kOfCamera>()
                                : find.template operator()<2 * kOfCamera>();
}

CalibrationPrior ExceedUsualErrors(CalibrationPrior stated) {
  const auto exceed = [](double sd, double usual) {
    return std::sqrt(std::max(sd * sd - usual * usual, 0.0));
  };
  stated.focal_sd = exceed(stated.focal_sd, kFocalSd);
  stated.principal_point_sd_px = exceed(stated.principal_point_sd_px, kPrincipalPointSdPx);
  stated.distortion_sd = exceed(stated.distortion_sd, kDistortionSd);
  return stated;
}

}  // namespace rcme
