// How far in front of the cameras matches lie, as an angle (rad) along the epipolar plane.
//
// With a = R ray1 and b = ray2, the depths are lambda1 = (b x t)'m / |b x t|^2 and lambda2 = (a x t)'m / |a x
// t|^2, m = a x b. |m| / (|a| |b|) is the angle between the rays, the parallax; its part within the epipolar
// plane is (b x t)'m / (|b x t| |a| |b|), or with a x t for camera 2. Both are positive in front of the
// cameras.
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

// Of the two cameras' the least, and their mean, which turns over with t.
struct DepthAngles {
  Vec least, mean;
};

HWY_INLINE DepthAngles DepthInNoise(const TwoViewPose& pose, const RayScale& scale, const Matches& m) {
  const Vec one = Set(1.0);
  const Vec3 ray1 = {m.x1 * Set(scale.x1), m.y1 * Set(scale.y1), one};
  const Vec3 b = {m.x2 * Set(scale.x2), m.y2 * Set(scale.y2), one};
  const auto row = [&](int i) {
    return Vec3{Set(pose.R[3 * i]), Set(pose.R[3 * i + 1]), Set(pose.R[3 * i + 2])};
  };
  const Vec3 t = {Set(pose.t[0]), Set(pose.t[1]), Set(pose.t[2])};
  const Vec3 a = Mat3{{row(0), row(1), row(2)}} * ray1;
  const Vec3 parallax = Cross(a, b), bt = Cross(b, t), at = Cross(a, t);
  const Vec tiny = Set(1e-30), inverse_length = one / hn::Sqrt(Dot(a, a) * Dot(b, b));
  const Vec depth1 = Dot(bt, parallax) * inverse_length / hn::Sqrt(Greater(Dot(bt, bt), tiny));
  const Vec depth2 = Dot(at, parallax) * inverse_length / hn::Sqrt(Greater(Dot(at, at), tiny));
  return {Lesser(depth1, depth2), Set(0.5) * (depth1 + depth2)};
}

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
