// Eight numbers side by side in vectors as wide as the instruction set allows, and 3-vectors of them.
// Included once per instruction set. Do not include Eigen here: its templates would be compiled for several
// sets.
//
// Every instruction set gives the same bits. Products and sums are fused, with one rounding, only where the
// source says FusedMulAdd. Sums over matches have eight partial sums, one for each place of a block, which
// are added in a fixed order (SumOfEight). Do not use those functions of Highway whose rounding depends on
// the instruction set: MulAdd and its kin, Min, Max, SumOfLanes, hwy/contrib/math.
#if defined(RCME_ESTIMATOR_KERNELS_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RCME_ESTIMATOR_KERNELS_LANES_INL_H_
#undef RCME_ESTIMATOR_KERNELS_LANES_INL_H_
#else
#define RCME_ESTIMATOR_KERNELS_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include <cmath>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<double, 8>;
using Vec = hn::Vec<Tag>;
using Mask = hn::Mask<Tag>;

constexpr int kLanes = static_cast<int>(hn::MaxLanes(Tag()));

HWY_INLINE Vec Set(double value) { return hn::Set(Tag(), value); }
HWY_INLINE Vec Load(const double* from) { return hn::Load(Tag(), from); }
HWY_INLINE void Store(Vec v, double* to) { hn::Store(v, Tag(), to); }
HWY_INLINE Vec Square(Vec a) { return a * a; }

// a b + c, a b - c and c - a b, rounded once. The scalar target calls the library's fma, which is slow on a
// machine without such an instruction.
#if HWY_TARGET == HWY_SCALAR
HWY_INLINE Vec FusedMulAdd(Vec a, Vec b, Vec c) { return Vec(std::fma(a.raw, b.raw, c.raw)); }
HWY_INLINE Vec FusedMulSub(Vec a, Vec b, Vec c) { return Vec(std::fma(a.raw, b.raw, -c.raw)); }
HWY_INLINE Vec FusedNegMulAdd(Vec a, Vec b, Vec c) { return Vec(std::fma(-a.raw, b.raw, c.raw)); }
#else
HWY_INLINE Vec FusedMulAdd(Vec a, Vec b, Vec c) { return hn::MulAdd(a, b, c); }
HWY_INLINE Vec FusedMulSub(Vec a, Vec b, Vec c) { return hn::MulSub(a, b, c); }
HWY_INLINE Vec FusedNegMulAdd(Vec a, Vec b, Vec c) { return hn::NegMulAdd(a, b, c); }
#endif
// If either argument is NaN, these return the second one.
HWY_INLINE Vec Lesser(Vec a, Vec b) { return hn::IfThenElse(a < b, a, b); }
HWY_INLINE Vec Greater(Vec a, Vec b) { return hn::IfThenElse(a > b, a, b); }

// Adds eight partial sums in a fixed order.
HWY_INLINE double SumOfEight(const double* s) {
  return ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]));
}
// Bit l is lane l of the mask.
HWY_INLINE unsigned ReadMaskBits(Mask mask) {
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(Tag(), mask, bits);
  return bits[0];
}

// The inverse of ReadMaskBits; bits beyond the lanes are ignored.
HWY_INLINE Mask MaskFromBits(unsigned bits) {
  const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(bits)};
  return hn::LoadMaskBits(Tag(), bytes);
}

#if HWY_TARGET == HWY_AVX2
// For each mask of four lanes the halves of the selected ones, side by side. Highway's own table is copied to the stack for
// every vector by g++ 12.
alignas(32) constexpr std::uint32_t kSelectedHalves[16][8] = {
    {0, 0, 0, 0, 0, 0, 0, 0}, {0, 1, 0, 0, 0, 0, 0, 0}, {2, 3, 0, 0, 0, 0, 0, 0}, {0, 1, 2, 3, 0, 0, 0, 0},
    {4, 5, 0, 0, 0, 0, 0, 0}, {0, 1, 4, 5, 0, 0, 0, 0}, {2, 3, 4, 5, 0, 0, 0, 0}, {0, 1, 2, 3, 4, 5, 0, 0},
    {6, 7, 0, 0, 0, 0, 0, 0}, {0, 1, 6, 7, 0, 0, 0, 0}, {2, 3, 6, 7, 0, 0, 0, 0}, {0, 1, 2, 3, 6, 7, 0, 0},
    {4, 5, 6, 7, 0, 0, 0, 0}, {0, 1, 4, 5, 6, 7, 0, 0}, {2, 3, 4, 5, 6, 7, 0, 0}, {0, 1, 2, 3, 4, 5, 6, 7}};
#endif

// Writes the selected lanes side by side and returns their number. Overwrites what follows them, up to a
// vector. The lanes are compressed in a register, because Highway's CompressStore to memory takes more than a
// hundred cycles on AMD's Zen 4.
HWY_INLINE size_t StoreSelected(Vec v, Mask mask, double* to) {
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX3
  _mm512_storeu_pd(to, _mm512_maskz_compress_pd(mask.raw, v.raw));
  return hn::CountTrue(Tag(), mask);
#elif HWY_TARGET == HWY_AVX2
  const hn::Repartition<std::uint32_t, Tag> halves;
  const unsigned bits = ReadMaskBits(mask);
  const auto selected =
      hn::TableLookupLanes(hn::BitCast(halves, v), hn::SetTableIndices(halves, kSelectedHalves[bits]));
  hn::StoreU(hn::BitCast(Tag(), selected), Tag(), to);
  return static_cast<size_t>(__builtin_popcount(bits));
#else
  return hn::CompressStore(v, mask, Tag(), to);
#endif
}

struct Vec3 {
  Vec x, y, z;
};
HWY_INLINE Vec Dot(const Vec3& a, const Vec3& b) {
  return FusedMulAdd(a.x, b.x, FusedMulAdd(a.y, b.y, a.z * b.z));
}
HWY_INLINE Vec3 Cross(const Vec3& a, const Vec3& b) {
  return {FusedMulSub(a.y, b.z, a.z * b.y), FusedMulSub(a.z, b.x, a.x * b.z),
          FusedMulSub(a.x, b.y, a.y * b.x)};
}
HWY_INLINE Vec3 Times(const Vec3& a, Vec s) { return {a.x * s, a.y * s, a.z * s}; }
// a s + b r
HWY_INLINE Vec3 Combine(const Vec3& a, Vec s, const Vec3& b, Vec r) {
  return {FusedMulAdd(a.x, s, b.x * r), FusedMulAdd(a.y, s, b.y * r), FusedMulAdd(a.z, s, b.z * r)};
}
HWY_INLINE Vec3 Normalized(const Vec3& a) { return Times(a, Set(1.0) / hn::Sqrt(Dot(a, a))); }
HWY_INLINE Vec3 Select(Mask first, const Vec3& a, const Vec3& b) {
  return {hn::IfThenElse(first, a.x, b.x), hn::IfThenElse(first, a.y, b.y), hn::IfThenElse(first, a.z, b.z)};
}

// A 3x3 matrix, row by row.
struct Mat3 {
  Vec3 row[3];
};
HWY_INLINE Vec3 operator*(const Mat3& m, const Vec3& v) {
  return {Dot(m.row[0], v), Dot(m.row[1], v), Dot(m.row[2], v)};
}
// m' v
HWY_INLINE Vec3 TransposeTimes(const Mat3& m, const Vec3& v) {
  const Vec3 upper = Combine(m.row[0], v.x, m.row[1], v.y);
  return {FusedMulAdd(m.row[2].x, v.z, upper.x), FusedMulAdd(m.row[2].y, v.z, upper.y),
          FusedMulAdd(m.row[2].z, v.z, upper.z)};
}

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
