// Brackets of the real roots of polynomials p of degree ten, eight side by side: intervals in which the sign
// changes.
//
// The roots lie on the circle of (z : w), including infinity, so p is used as a homogeneous polynomial: in
// the chart z (w = 1) if |z| <= 1, else in the chart u = w / z. At fixed nodes around the circle, changes of
// the sign of p separate the roots. Two roots between the same nodes show as a local minimum of |p|.
#if defined(RCME_ESTIMATOR_KERNELS_FIVE_POINT_BRACKETS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RCME_ESTIMATOR_KERNELS_FIVE_POINT_BRACKETS_INL_H_
#undef RCME_ESTIMATOR_KERNELS_FIVE_POINT_BRACKETS_INL_H_
#else
#define RCME_ESTIMATOR_KERNELS_FIVE_POINT_BRACKETS_INL_H_
#endif

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "estimator/kernels/five_point_block.h"
#include "estimator/kernels/five_point_polynomial-inl.h"
#include "estimator/kernels/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

constexpr int kQuarter = 32, kNumNodes = 4 * kQuarter;

// Node n, in order around the circle: u = 0, then u down to -1, z = -1 up to 1, u = 1 down to 0 again.
struct Node {
  double t;         // z or u
  bool is_inverse;  // t is u
};
constexpr Node ComputeNode(int n) {
  if (n < kQuarter) return {-static_cast<double>(n) / kQuarter, true};
  if (n <= 3 * kQuarter) return {static_cast<double>(n - 2 * kQuarter) / kQuarter, false};
  return {static_cast<double>(kNumNodes - n) / kQuarter, true};
}
// The interval between a node and the next one, in one chart.
struct Interval {
  double begin, end, is_inverse;  // 0 or 1
};
constexpr std::array<Interval, kNumNodes> MakeIntervals() {
  std::array<Interval, kNumNodes> intervals{};
  for (int n = 0; n < kNumNodes; ++n) {
    // The charts agree at t = 1 and t = -1.
    const Node a = ComputeNode(n), b = ComputeNode((n + 1) % kNumNodes);
    intervals[static_cast<size_t>(n)] = {a.t, b.t, a.is_inverse || b.is_inverse ? 1.0 : 0.0};
  }
  return intervals;
}
inline constexpr std::array<Interval, kNumNodes> kIntervals = MakeIntervals();

// p at the nodes, [node][sample]; bit s of a byte belongs to sample s.
struct alignas(64) NodeValues {
  static constexpr int kPad = 8;  // bytes before node 0 and after the last; these nodes wrap around

  double p[kNumNodes][kBlockSize];
  std::uint8_t is_negative[kPad + kNumNodes + kPad];
  std::uint8_t falls[kPad + kNumNodes + kPad];  // |p| is less than at the previous node
};

// Writes the values at the nodes, one polynomial per lane from lane `lane` of the block on.
class NodeWriter {
 public:
  NodeWriter(int lane, NodeValues* values) : lane_(lane), values_(values) {}
  HWY_INLINE void WriteValue(int n, Vec p) const {
    Store(p, values_->p[n] + lane_);
    WriteBits(p < Set(0.0), &values_->is_negative[NodeValues::kPad + n]);
  }
  HWY_INLINE void WriteFall(int n, Vec before, Vec p) const {
    WriteBits(hn::Abs(p) < hn::Abs(before), &values_->falls[NodeValues::kPad + n]);
  }

 private:
  HWY_INLINE void WriteBits(Mask mask, std::uint8_t* byte) const {
    if constexpr (kLanes == kBlockSize) {
      hn::StoreMaskBits(Tag(), mask, byte);
      return;
    }
    const unsigned bits = ReadMaskBits(mask) << lane_;
    *byte = static_cast<std::uint8_t>(lane_ == 0 ? bits : *byte | bits);
  }
  int lane_;
  NodeValues* values_;
};

// p(t) = even(t^2) + t odd(t^2), so that t and -t in both charts need four sums of half the degree.
HWY_INLINE void EvaluateAtNodes(const Vec (&p)[kDegree + 1], int lane, NodeValues* values) {
  const NodeWriter writer(lane, values);
  Vec z_plus = p[0], z_minus = p[0], u_plus = p[kDegree], u_minus = p[kDegree];
  writer.WriteValue(2 * kQuarter, z_plus);
  writer.WriteValue(0, u_plus);
  for (int step = 1; step <= kQuarter; ++step) {
    const Vec t = Set(static_cast<double>(step) / kQuarter), t2 = t * t;
    Vec even = p[10], odd = p[9], inverse_even = p[0], inverse_odd = p[1];
    for (int c = 8; c >= 0; c -= 2) even = FusedMulAdd(even, t2, p[c]);
    for (int c = 7; c >= 1; c -= 2) odd = FusedMulAdd(odd, t2, p[c]);
    const Vec z_after = FusedMulAdd(odd, t, even), z_before = FusedNegMulAdd(odd, t, even);
    writer.WriteValue(2 * kQuarter + step, z_after);
    writer.WriteValue(2 * kQuarter - step, z_before);
    writer.WriteFall(2 * kQuarter + step, z_plus, z_after);
    writer.WriteFall(2 * kQuarter - step + 1, z_before, z_minus);
    Vec u_after = z_after, u_before = z_before;  // at t = 1 the charts meet
    if (step < kQuarter) {
      for (int c = 2; c <= 10; c += 2) inverse_even = FusedMulAdd(inverse_even, t2, p[c]);
      for (int c = 3; c <= 9; c += 2) inverse_odd = FusedMulAdd(inverse_odd, t2, p[c]);
      u_after = FusedMulAdd(inverse_odd, t, inverse_even);
      u_before = FusedNegMulAdd(inverse_odd, t, inverse_even);
      writer.WriteValue(kNumNodes - step, u_after);
      writer.WriteValue(step, u_before);
    }
    writer.WriteFall((kNumNodes - step + 1) % kNumNodes, u_after, u_plus);
    writer.WriteFall(step, u_minus, u_before);
    z_plus = z_after, z_minus = z_before, u_plus = u_after, u_minus = u_before;
  }
}

// The brackets of all samples. A sample's brackets follow the circle; those of close pairs come last.
struct alignas(64) Brackets {
  static constexpr int kCapacity = FivePointModels::kMaxPerSample * kBlockSize + 2 * kBlockSize;

  double begin[kCapacity], end[kCapacity], at_begin[kCapacity], at_end[kCapacity];  // t and p there
  double is_inverse[kCapacity];                                                     // 1: t is u, 0: t is z
  std::int64_t sample[kCapacity];
  int count = 0, num_of_sample[kBlockSize] = {};

  // Drops further brackets: a polynomial has at most ten roots, but rounding may show more.
  HWY_INLINE void Add(const Interval& interval, double p_begin, double p_end, int of_sample) {
    if (num_of_sample[of_sample] == FivePointModels::kMaxPerSample) return;
    ++num_of_sample[of_sample];
    begin[count] = interval.begin;
    end[count] = interval.end;
    at_begin[count] = p_begin;
    at_end[count] = p_end;
    is_inverse[count] = interval.is_inverse;
    sample[count++] = of_sample;
  }
  // Whole vectors are read, so the places beyond the last bracket are set to zero.
  void Close() {
    for (int i = count; i < count + 2 * kBlockSize; ++i) {
      begin[i] = end[i] = at_begin[i] = at_end[i] = is_inverse[i] = 0.0;
      sample[i] = 0;
    }
  }
};

// p and its first two derivatives at t; `p` has ascending powers of t.
struct Jet {
  double p, d, dd;
};
inline Jet EvaluateJet(const double* p, double t) {
  Jet jet{p[kDegree], 0.0, 0.0};
  for (int c = kDegree - 1; c >= 0; --c) {
    jet.dd = jet.dd * t + jet.d;
    jet.d = jet.d * t + jet.p;
    jet.p = jet.p * t + p[c];
  }
  jet.dd *= 2.0;
  return jet;
}

// The extremum of p between the nodes around node n, where |p| has a local minimum.
struct Extremum {
  double t, p, curvature;
};

// Whether p has the other sign at this extremum, that is, two roots. Takes Newton steps on p' from the node
// until p has changed its sign, or until the local parabola shows that it does not.
inline bool FindPair(const BlockPolynomials& polynomials, int sample, int n, Extremum* extremum) {
  const Node node = ComputeNode(n);
  double p[kDegree + 1];
  for (int c = 0; c <= kDegree; ++c) p[c] = polynomials.p[node.is_inverse ? kDegree - c : c][sample];
  double t = node.t;
  Jet jet = EvaluateJet(p, t);
  const bool was_negative = jet.p < 0.0;
  for (int step = 0; step < 4; ++step) {
    const double newton = jet.d / jet.dd, lowest = jet.p - 0.5 * jet.d * newton;
    if (!(std::abs(lowest) < 0.5 * std::abs(jet.p)) && (lowest < 0.0) == was_negative) return false;
    t -= newton;
    if (!(std::abs(t - node.t) < 1.0 / kQuarter)) return false;
    jet = EvaluateJet(p, t);
    if ((jet.p < 0.0) != was_negative) {
      *extremum = {t, jet.p, jet.dd};
      return true;
    }
  }
  return false;
}

// The bytes of nodes n to n + 7.
inline std::uint64_t LoadEight(const std::uint8_t* bytes, int n) {
  std::uint64_t word;
  std::memcpy(&word, bytes + NodeValues::kPad + n, sizeof(word));
  return word;
}

// Copies the bytes of each end to the padding beyond the other end.
inline void WrapAround(std::uint8_t* bytes) {
  std::memcpy(bytes, bytes + kNumNodes, NodeValues::kPad);
  std::memcpy(bytes + NodeValues::kPad + kNumNodes, bytes + NodeValues::kPad, NodeValues::kPad);
}

// Bit s of byte n: p of sample s changes its sign between node n and the next.
struct SignChanges {
  std::uint8_t bytes[NodeValues::kPad + kNumNodes + NodeValues::kPad];

  explicit SignChanges(NodeValues* values) {
    WrapAround(values->is_negative);
    for (int n = 0; n < kNumNodes; n += 8) {
      const std::uint64_t change = LoadEight(values->is_negative, n) ^ LoadEight(values->is_negative, n + 1);
      std::memcpy(bytes + NodeValues::kPad + n, &change, sizeof(change));
    }
    WrapAround(bytes);
  }
};

inline void AddSignChanges(const NodeValues& values, const SignChanges& changes, Brackets* brackets) {
  for (int n = 0; n < kNumNodes; n += 8) {
    for (std::uint64_t left = LoadEight(changes.bytes, n); left != 0; left &= left - 1) {
      const int bit = __builtin_ctzll(left), node = n + bit / 8, sample = bit % 8;
      brackets->Add(kIntervals[static_cast<size_t>(node)], values.p[node][sample],
                    values.p[(node + 1) % kNumNodes][sample], sample);
    }
  }
}

// Near the extremum p is close to a parabola, extremum.p + curvature / 2 (t - extremum.t)^2. Its roots are at
// a distance `half` to both sides; at twice this distance p is -3 extremum.p.
inline void AddPair(const Extremum& extremum, const Node& node, int sample, Brackets* brackets) {
  const double forward = node.is_inverse ? -1.0 : 1.0;  // along the circle
  const double half = std::sqrt(-2.0 * extremum.p / extremum.curvature), reach = 2.0 * forward * half;
  const double is_inverse = node.is_inverse ? 1.0 : 0.0, beyond = -3.0 * extremum.p;
  brackets->Add({extremum.t - reach, extremum.t, is_inverse}, beyond, extremum.p, sample);
  brackets->Add({extremum.t, extremum.t + reach, is_inverse}, extremum.p, beyond, sample);
}

inline void AddPairs(const BlockPolynomials& polynomials, const SignChanges& changes, NodeValues* values,
                     Brackets* brackets) {
  WrapAround(values->falls);
  for (int n = 0; n < kNumNodes; n += 8) {
    const std::uint64_t minima = LoadEight(values->falls, n) & ~LoadEight(values->falls, n + 1) &
                                 ~LoadEight(changes.bytes, n) & ~LoadEight(changes.bytes, n - 1);
    for (std::uint64_t left = minima; left != 0; left &= left - 1) {
      const int bit = __builtin_ctzll(left), node = n + bit / 8, sample = bit % 8;
      Extremum extremum;
      if (FindPair(polynomials, sample, node, &extremum))
        AddPair(extremum, ComputeNode(node), sample, brackets);
    }
  }
}

inline void FindBrackets(const BlockPolynomials& polynomials, NodeValues* values, Brackets* brackets) {
  const SignChanges changes(values);
  AddSignChanges(*values, changes, brackets);
  AddPairs(polynomials, changes, values, brackets);
  brackets->Close();
}

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
