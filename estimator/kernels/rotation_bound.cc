#include "estimator/kernels/rotation_bound.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "estimator/kernels/rotation_bound.cc"
#include <hwy/foreach_target.h>
// The above must come before these.
#include "estimator/kernels/epipolar-inl.h"

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

// The rays of a match as unit vectors.
struct UnitRays {
  Vec3 first, second;
};

HWY_INLINE UnitRays LoadUnitRays(const MatchBlock& block, const RayScale& scale, int lane) {
  const Matches m = LoadMatches(block, lane);
  return {Normalized({m.x1 * Set(scale.x1), m.y1 * Set(scale.y1), Set(1.0)}),
          Normalized({m.x2 * Set(scale.x2), m.y2 * Set(scale.y2), Set(1.0)})};
}

HWY_INLINE Vec SquaredDistance(const Vec3& a, const Vec3& b) {
  const Vec3 d = {a.x - b.x, a.y - b.y, a.z - b.z};
  return Dot(d, d);
}

// Whether one rotation can explain both matches: | |a| - |b| | <= reach, where a and b are the differences in
// the two images. This is equivalent to a^2 + b^2 - reach^2 <= 2 |a| |b|.
HWY_INLINE Mask CanShareRotation(const UnitRays& i, const UnitRays& j, Vec squared_reach) {
  const Vec a2 = SquaredDistance(i.first, j.first), b2 = SquaredDistance(i.second, j.second);
  const Vec excess = (a2 + b2) - squared_reach;
  return hn::Not(hn::And(excess > Set(0.0), Square(excess) > Set(4.0) * a2 * b2));
}

// The bound for the group of each lane, which consists of one match of each of `size` blocks.
HWY_INLINE Vec BoundGroup(const MatchBlock* blocks, int size, const RayScale& scale, int lane,
                          Vec squared_reach) {
  const Vec one = Set(1.0);
  UnitRays rays[kBlockSize];
  Vec partners[kBlockSize];
  for (int i = 0; i < size; ++i) {
    rays[i] = LoadUnitRays(blocks[i], scale, lane);
    partners[i] = Set(0.0);
    for (int j = 0; j < i; ++j) {
      const Vec both = hn::IfThenElseZero(CanShareRotation(rays[i], rays[j], squared_reach), one);
      partners[i] = partners[i] + both;
      partners[j] = partners[j] + both;
    }
  }
  Vec most = one;
  for (int k = 2; k <= size; ++k) {
    const Vec enough = Set(k - 1.0), wanted = Set(1.0 * k);
    Vec count = Set(0.0);
    for (int i = 0; i < size; ++i) count = count + hn::IfThenElseZero(partners[i] >= enough, one);
    most = hn::IfThenElse(count >= wanted, wanted, most);
  }
  return most;
}

double SumGroupBounds(const MatchBlocks& matches, double squared_reach) {
  return SumOverLanes([&](int lane) {
    Vec sum = Set(0.0);
    for (int b = 0; b < matches.num_blocks(); b += kBlockSize) {
      const int size = std::min(kBlockSize, matches.num_blocks() - b);
      sum = sum + BoundGroup(&matches[b], size, matches.ray_scale(), lane, Set(squared_reach));
    }
    return sum;
  });
}

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rcme {

HWY_EXPORT(SumGroupBounds);

int BoundRotated(const MatchBlocks& matches, double threshold) {
  const RayScale& s = matches.ray_scale();
  const double greatest = std::max({s.x1, s.y1, s.x2, s.y2});
  const double squared_reach = 9.68 * threshold * greatest * greatest;  // (2 tau)^2
  const double bound = HWY_DYNAMIC_DISPATCH(SumGroupBounds)(matches, squared_reach);
  // the bound includes lanes beyond the last match
  return std::min(static_cast<int>(bound), matches.num_matches());
}

}  // namespace rcme
#endif
