// Doubles of an estimator: answers that are sound, or have one planted fault. They know the true motion.
#pragma once

#include <Eigen/Cholesky>
#include <cmath>
#include <vector>

#include "estimator/motion_estimate.h"
#include "experiments/audit/claims/calibration.h"
#include "experiments/audit/claims/call_estimator.h"
#include "stats/constants.h"
#include "stats/random.h"

namespace rcme {

inline const RelativePose kMotionOfDoubles{RotationFromVector({0.5, -0.4, 0.6}),
                                           Eigen::Vector3d(0.6, 0.0, 0.8)};
inline constexpr double kSigmaOfDoublesPx = 0.5;

// Correlated, with standard deviations of 0.06 to 0.32 deg; rad^2.
inline Matrix5d ErrorCovarianceOfDoubles() {
  Matrix5d factor = Matrix5d::Zero();
  for (int i = 0; i < 5; ++i) {
    factor(i, i) = 1e-3 * (1.0 + i);
    if (i > 0) factor(i, i - 1) = -5e-4 * i;
  }
  return factor * factor.transpose();
}

// An answer around which the truth is distributed as its covariance says: the coordinates of the truth in the
// tangent at the answer are normal. An error drawn in the tangent at the truth would not do: the two tangents
// are turned against each other by the error.
inline MotionEstimate AnswerWithErrors(const RelativePose& pose_true, const Matrix5d& covariance,
                                       RandomStream& rng) {
  Vector5d normal;
  for (double& each : normal) each = rng.Normal();
  const Vector5d wanted = covariance.llt().matrixL() * normal;
  MotionEstimate answer;
  answer.status = MotionStatus::kOk;
  answer.cam2_from_cam1 = pose_true;
  for (int i = 0; i < 6; ++i) {
    const Vector5d off = LocalCoordinates(answer.cam2_from_cam1, pose_true) - wanted;
    answer.cam2_from_cam1 = Retract(answer.cam2_from_cam1, off);
  }
  answer.pose_cov = covariance;
  return answer;
}

// Of an estimator that states motion and covariance alone, and is never beyond the bounds.
inline MotionEstimate PlainAnswer(RandomStream& rng) {
  return AnswerWithErrors(kMotionOfDoubles, ErrorCovarianceOfDoubles(), rng);
}

// Of one that states a probability of failure and the noise level too. One trial in six is hard: it fails
// with a probability that is uniform on 0..0.5, and that is stated. Sigma is that of 95 degrees of freedom.
inline MotionEstimate FullAnswer(RandomStream& rng) {
  constexpr int kFreedom = 95;
  MotionEstimate answer = PlainAnswer(rng);
  answer.failure_probability = rng.Uniform() < 1.0 / 6.0 ? 0.5 * rng.Uniform() : 0.0;
  if (rng.Uniform() < answer.failure_probability) answer.cam2_from_cam1.t *= -1.0;
  double sum = 0.0;
  for (int i = 0; i < kFreedom; ++i) sum += std::pow(rng.Normal(), 2.0);
  answer.sigma_estimated_px = kSigmaOfDoublesPx * std::sqrt(sum / kFreedom);
  answer.sigma_estimated_sd_px = answer.sigma_estimated_px / std::sqrt(2.0 * kFreedom);
  return answer;
}

// The claim that is to find a fault; the others may.
enum class FoundBy { kNoClaim, kCoverageClaim, kFailureClaim, kSigmaClaim };

struct DoubledFault {
  const char* name;
  FoundBy found_by;
  MotionEstimate (*draw)(RandomStream& rng);
  void (*plant)(MotionEstimate* answer, RandomStream& rng);
};

template <int kPerMille>
void FlipDirection(MotionEstimate* answer, RandomStream& rng) {
  if (rng.Uniform() < 1e-3 * kPerMille) answer->cam2_from_cam1.t *= -1.0;
}
// An error of ten standard deviations, within the failure bounds.
template <int kPerMille>
void MakeGrossError(MotionEstimate* answer, RandomStream& rng) {
  const Matrix5d factor = answer->pose_cov.llt().matrixL();
  if (rng.Uniform() < 1e-3 * kPerMille)
    answer->cam2_from_cam1 = Retract(answer->cam2_from_cam1, 10.0 * factor.col(0));
}
template <int kPercent>
void ScaleCovariance(MotionEstimate* answer, RandomStream&) {
  answer->pose_cov *= std::pow(0.01 * kPercent, 2.0);
}
template <int kPercent>
void ScaleSigma(MotionEstimate* answer, RandomStream&) {
  answer->sigma_estimated_px *= 0.01 * kPercent;
}
template <int kPercent>
void ScaleProbability(MotionEstimate* answer, RandomStream&) {
  answer->failure_probability *= 0.01 * kPercent;
}

// A right perturbation, R Exp(w'), has w = R w'.
inline void ReportInRightCoordinates(MotionEstimate* answer, RandomStream&) {
  Matrix5d turn = Matrix5d::Identity();
  turn.topLeftCorner<3, 3>() = answer->cam2_from_cam1.R.transpose();
  answer->pose_cov = turn * answer->pose_cov * turn.transpose();
}

// Sound answers first.
inline const std::vector<DoubledFault>& DoubledFaults() {
  static const auto nothing = [](MotionEstimate*, RandomStream&) {};
  static const std::vector<DoubledFault> faults = {
      {"sound: covariance alone", FoundBy::kNoClaim, PlainAnswer, nothing},
      {"sound: P and sigma stated", FoundBy::kNoClaim, FullAnswer, nothing},
      {"NaN in R in 10 % of the answers", FoundBy::kCoverageClaim, PlainAnswer,
       [](MotionEstimate* a, RandomStream& rng) {
         if (rng.Uniform() < 0.1) a->cam2_from_cam1.R(1, 2) = kNaN;
       }},
      {"NaN in t in 10 % of the answers", FoundBy::kCoverageClaim, PlainAnswer,
       [](MotionEstimate* a, RandomStream& rng) {
         if (rng.Uniform() < 0.1) a->cam2_from_cam1.t(0) = kNaN;
       }},
      {"NaN in the covariance in 10 % of the answers", FoundBy::kCoverageClaim, PlainAnswer,
       [](MotionEstimate* a, RandomStream& rng) {
         if (rng.Uniform() < 0.1) a->pose_cov(3, 3) = kNaN;
       }},
      {"t = 0", FoundBy::kCoverageClaim, PlainAnswer,
       [](MotionEstimate* a, RandomStream&) { a->cam2_from_cam1.t.setZero(); }},
      {"reflection instead of a rotation", FoundBy::kCoverageClaim, PlainAnswer,
       [](MotionEstimate* a, RandomStream&) { a->cam2_from_cam1.R.col(2) *= -1.0; }},
      {"1000 R", FoundBy::kCoverageClaim, PlainAnswer,
       [](MotionEstimate* a, RandomStream&) { a->cam2_from_cam1.R *= 1000.0; }},
      {"asymmetric covariance", FoundBy::kCoverageClaim, PlainAnswer,
       [](MotionEstimate* a, RandomStream&) {
         a->pose_cov(0, 1) += 0.1 * std::sqrt(a->pose_cov(0, 0) * a->pose_cov(1, 1));
       }},
      {"one axis of the covariance in degrees", FoundBy::kCoverageClaim, PlainAnswer,
       [](MotionEstimate* a, RandomStream&) {
         a->pose_cov.row(1) *= kDegPerRad;
         a->pose_cov.col(1) *= kDegPerRad;
       }},
      {"covariance of a right perturbation", FoundBy::kCoverageClaim, PlainAnswer, ReportInRightCoordinates},
      {"covariance 10 % too small in sigma", FoundBy::kCoverageClaim, PlainAnswer, ScaleCovariance<90>},
      {"covariance 12 % too great in sigma", FoundBy::kCoverageClaim, PlainAnswer, ScaleCovariance<112>},
      {"errors of ten sigma in 2 % of the answers", FoundBy::kCoverageClaim, PlainAnswer, MakeGrossError<20>},
      {"errors of ten sigma in 1 % of the answers", FoundBy::kCoverageClaim, PlainAnswer, MakeGrossError<10>},
      {"sign of t flipped in 2 % of the answers", FoundBy::kFailureClaim, PlainAnswer, FlipDirection<20>},
      {"sign of t flipped in 1 % of the answers", FoundBy::kFailureClaim, PlainAnswer, FlipDirection<10>},
      {"sign of t flipped in 0.5 % of the answers", FoundBy::kFailureClaim, PlainAnswer, FlipDirection<5>},
      {"sign of t flipped in 2 %, P stated without it", FoundBy::kFailureClaim, FullAnswer,
       FlipDirection<20>},
      {"sign of t flipped in 1 %, P stated without it", FoundBy::kFailureClaim, FullAnswer,
       FlipDirection<10>},
      {"P three tenths of what is right", FoundBy::kFailureClaim, FullAnswer, ScaleProbability<30>},
      {"P twice as great", FoundBy::kFailureClaim, FullAnswer, ScaleProbability<200>},
      {"one P for all", FoundBy::kFailureClaim, FullAnswer,
       [](MotionEstimate* a, RandomStream&) { a->failure_probability = 1.0 / 24.0; }},
      {"sigma 10 % too great", FoundBy::kSigmaClaim, FullAnswer, ScaleSigma<110>},
      {"sigma 10 % too small", FoundBy::kSigmaClaim, FullAnswer, ScaleSigma<90>},
      {"sd of sigma half as great", FoundBy::kSigmaClaim, FullAnswer,
       [](MotionEstimate* a, RandomStream&) { a->sigma_estimated_sd_px *= 0.5; }}};
  return faults;
}

// An estimator that gives the answers of a double.
class DoubledEstimator : public MotionEstimator {
 public:
  explicit DoubledEstimator(const DoubledFault& fault) : fault_(fault) {}

  MotionEstimate Estimate(const MotionProblem&, RandomStream& rng) const override {
    MotionEstimate answer = fault_.draw(rng);
    fault_.plant(&answer, rng);
    return answer;
  }

 private:
  DoubledFault fault_;
};

// A case without matches that has the doubles' motion and noise level.
inline Case CaseOfDoubles(const StreamName& name) {
  Case made{name, {}, {}, StreamFor(name, StreamPurpose::kCheck), kSigmaOfDoublesPx};
  made.data.truth.cam2_from_cam1_true = kMotionOfDoubles;
  return made;
}

// The claim's one check with answers of the double in the place of a scene's.
inline Check CheckOfDoubles(const CaseClaim& claim) {
  Check check;
  check.targets = claim.targets;
  check.limits = claim.limits;
  check.not_stated = claim.not_stated;
  check.trial = [statistic = claim.statistic](const StreamName& name) {
    Case made = CaseOfDoubles(name);
    return statistic(made);
  };
  return check;
}

}  // namespace rcme
