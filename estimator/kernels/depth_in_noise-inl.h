// How far in front of the cameras matches lie, as an angle (rad) along the epipolar plane.
//
// With a = R ray1, b = ray2 and m = a x b, the depths are
//
//   lambda1 = (b x t)'m / |b x t|^2,   lambda2 = (a x t)'m / |a x t|^2.
//
// The parallax, the angle between the rays, is |m| / (|a| |b|). Its component within the epipolar plane is (b
// x t)'m / (|b x t| |a| |b|); for camera 2, a x t replaces b x t. Both are positive in front of the cameras.
// Products of cross products are expressed by scalar products (Lagrange's identity) with |t| = 1.
#if defined(RCME_ESTIMATOR_KERNELS_DEPTH_IN_NOISE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RCME_ESTIMATOR_KERNELS_DEPTH_IN_NOISE_INL_H_
#undef RCME_ESTIMATOR_KERNELS_DEPTH_IN_NOISE_INL_H_
#else
#define RCME_ESTIMATOR_KERNELS_DEPTH_IN_NOISE_INL_H_
#endif

#include "estimator/kernels/epipolar-inl.h"
#include "estimator/kernels/two_view_pose.h"

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

// The angle along / sqrt(square).
struct DepthAngle {
  Vec along, square;
};
// In cameras 1 and 2.
struct DepthAngles {
  DepthAngle in1, in2;
};

HWY_INLINE DepthAngles EvaluateDepths(const TwoViewPose& pose, const RayScale& scale, const Matches& m) {
  const Vec one = Set(1.0), tiny = Set(1e-30);
  const Vec3 ray1 = {m.x1 * Set(scale.x1), m.y1 * Set(scale.y1), one};
  const Vec3 b = {m.x2 * Set(scale.x2), m.y2 * Set(scale.y2), one};
  const auto row = [&](int i) {
    return Vec3{Set(pose.R[3 * i]), Set(pose.R[3 * i + 1]), Set(pose.R[3 * i + 2])};
  };
  const Vec3 t = {Set(pose.t[0]), Set(pose.t[1]), Set(pose.t[2])};
  const Vec3 a = Mat3{{row(0), row(1), row(2)}} * ray1;
  const Vec aa = Dot(a, a), bb = Dot(b, b), ab = Dot(a, b), at = Dot(a, t), bt = Dot(b, t), both = aa * bb;
  return {{FusedMulSub(ab, bt, bb * at), Greater(FusedNegMulAdd(bt, bt, bb), tiny) * both},
          {FusedMulSub(aa, bt, ab * at), Greater(FusedNegMulAdd(at, at, aa), tiny) * both}};
}

HWY_INLINE DepthAngle Least(const DepthAngles& depths) {
  const DepthAngle &p = depths.in1, &q = depths.in2;
  const Mask is_first =
      p.along * hn::Abs(p.along) * q.square < q.along * hn::Abs(q.along) * p.square;  // signed squares
  return {hn::IfThenElse(is_first, p.along, q.along), hn::IfThenElse(is_first, p.square, q.square)};
}

HWY_INLINE Vec ComputeAngle(const DepthAngle& depth) { return depth.along / hn::Sqrt(depth.square); }

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
