// The side of the cameras on which triangulated points lie; see geometry/triangulation.h for the scalar twin.
//
// With y = R ray1, the point is (y + rho t) times the depth. The inverse depth in baselines is rho = w / q
// with w = -(ray2 x y)'(ray2 x t), q = |ray2 x t|^2. Only signs are needed, so there is no division: rho > 0
// if w > 0, and the depth in camera 2 has the sign of q y_z + w t_z. Reversing t reverses w and keeps this
// depth.
#if defined(RCME_ESTIMATOR_KERNELS_CHEIRALITY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RCME_ESTIMATOR_KERNELS_CHEIRALITY_INL_H_
#undef RCME_ESTIMATOR_KERNELS_CHEIRALITY_INL_H_
#else
#define RCME_ESTIMATOR_KERNELS_CHEIRALITY_INL_H_
#endif

#include "estimator/kernels/epipolar-inl.h"
#include "estimator/kernels/two_view_pose.h"

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

struct Sides {
  Vec3 ray2, ray1_in_cam2;
  Vec inverse_depth;  // w; only its sign has a meaning
  Mask is_ahead_of_camera2;
};

HWY_INLINE Sides EvaluateSides(const TwoViewPose& pose, const RayScale& scale, const Matches& m) {
  const Vec one = Set(1.0);
  const Vec3 ray1 = {m.x1 * Set(scale.x1), m.y1 * Set(scale.y1), one};
  const Vec3 ray2 = {m.x2 * Set(scale.x2), m.y2 * Set(scale.y2), one};
  const auto row = [&](int i) {
    return Vec3{Set(pose.R[3 * i]), Set(pose.R[3 * i + 1]), Set(pose.R[3 * i + 2])};
  };
  const Vec3 y = Mat3{{row(0), row(1), row(2)}} * ray1;
  const Vec3 parallax = Cross(ray2, {Set(pose.t[0]), Set(pose.t[1]), Set(pose.t[2])});
  const Vec w = hn::Neg(Dot(Cross(ray2, y), parallax));
  const Vec depth = FusedMulAdd(Dot(parallax, parallax), y.z, w * Set(pose.t[2]));
  return {ray2, y, w, depth > Set(0.0)};
}

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
