#include "estimator/kernels/exact_block.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "estimator/kernels/exact_block.cc"
#include <hwy/foreach_target.h>
// The above must come before these.
#include "estimator/kernels/hypothesis_lanes-inl.h"
#include "estimator/kernels/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

// In the coordinates y of delta f = T y (T the orthonormal basis of the motions at f, the unit E), the five
// constraints c_k'f of the sample have the Jacobian H_ki = c_k'T_i. So noise n moves y by -H^-1 n, and
// Sigma_y = L L' (eq. 5) with L = H^-1 D^(1/2): the root needs no Cholesky factorization.
struct Equations {
  Vec columns[5][5];  // H, column by column; after Factor, R
  Vec rhs[5][5];      // D^(1/2), column by column; L after Solve
  Vec smallest_pivot, largest_pivot;
};

HWY_INLINE Equations MakeEquations(const SampleLanes<5>& sample, const Whitening& whitening,
                                   const EssentialBasis& basis, const Vec* f) {
  Vec constraints[5][9], T[5][9], D[5];
  FillConstraints(sample, whitening, constraints);
  ConstraintVariances(sample, whitening, f, D);
  MotionBasis(basis, T);
  Equations equations;
  for (int i = 0; i < 5; ++i) {
    for (int k = 0; k < 5; ++k) {
      Vec sum = constraints[k][0] * T[i][0];
      for (int c = 1; c < 9; ++c) sum = FusedMulAdd(constraints[k][c], T[i][c], sum);
      equations.columns[i][k] = sum;
      equations.rhs[i][k] = i == k ? hn::Sqrt(D[k]) : Set(0.0);
    }
  }
  return equations;
}

// b + tau v (v'b), rows from `first` on.
HWY_INLINE void ReflectFrom(int first, const Vec* v, Vec tau, Vec* b) {
  Vec sum = v[first] * b[first];
  for (int row = first + 1; row < 5; ++row) sum = FusedMulAdd(v[row], b[row], sum);
  const Vec weight = tau * sum;
  for (int row = first; row < 5; ++row) b[row] = FusedMulAdd(v[row], weight, b[row]);
}

// Householder reflections of H and of the right-hand sides, H = Q R (formulas: null_vector-inl.h).
HWY_INLINE void Factor(Equations& e) {
  for (int j = 0; j < 5; ++j) {
    Vec* x = e.columns[j];
    Vec squared = x[j] * x[j];
    for (int row = j + 1; row < 5; ++row) squared = FusedMulAdd(x[row], x[row], squared);
    const Vec norm = hn::Sqrt(squared), alpha = hn::CopySign(norm, hn::Neg(x[j]));
    x[j] = x[j] - alpha;
    const Vec tau = Set(1.0) / (alpha * x[j]);
    for (int c = j + 1; c < 5; ++c) ReflectFrom(j, x, tau, e.columns[c]);
    for (int c = 0; c < 5; ++c) ReflectFrom(j, x, tau, e.rhs[c]);
    x[j] = alpha;  // R_jj; the entries below it are not needed any more
    e.smallest_pivot = j == 0 ? norm : Lesser(norm, e.smallest_pivot);
    e.largest_pivot = j == 0 ? norm : Greater(norm, e.largest_pivot);
  }
}

HWY_INLINE void Solve(Equations& e) {
  for (int j = 4; j >= 0; --j) {
    const Vec inverse = Set(1.0) / e.columns[j][j];
    for (int c = 0; c < 5; ++c) {
      Vec rest = e.rhs[c][j];
      for (int k = j + 1; k < 5; ++k) rest = FusedNegMulAdd(e.columns[k][j], e.rhs[c][k], rest);
      e.rhs[c][j] = rest * inverse;
    }
  }
}

// Fills dF of some lanes along the columns of L, where L L' is Sigma_p (eq::cov_p) in the basis T. Returns
// the lanes whose dF is finite and whose motion is an isolated solution.
HWY_INLINE Mask FillDerivatives(const SampleLanes<5>& sample, const EssentialBasis& basis, const Vec* f,
                                const Whitening& whitening, int lane, HypothesisBlock* block) {
  Equations equations = MakeEquations(sample, whitening, basis, f);
  Factor(equations);
  Solve(equations);
  Vec sum = Set(0.0);
  for (int k = 0; k < 5; ++k) {
    Mat3 dE;
    Derivative(basis, equations.rhs[k], &dE);
    StoreWhitened(dE, whitening, lane, block->dF[k]);
    for (int i = 0; i < 5; ++i) sum = FusedMulAdd(equations.rhs[k][i], equations.rhs[k][i], sum);
  }
  return hn::And(hn::IsFinite(sum), equations.smallest_pivot > Set(1e-9) * equations.largest_pivot);
}

// Fills lanes [lane, lane + kLanes) of the block: the motion of f (eq::motion_estimate) and its spread.
template <bool has_spread>
HWY_INLINE Mask FillLanes(const EssentialBlock& essentials, const Whitening& whitening, int lane,
                          HypothesisBlock* block) {
  Vec E[9];
  for (int i = 0; i < 9; ++i) E[i] = Load(essentials.E[i] + lane);
  const EssentialBasis basis =
      ProjectToEssential({{{E[0], E[1], E[2]}, {E[3], E[4], E[5]}, {E[6], E[7], E[8]}}});
  const auto row = [&](Vec a, Vec b) { return Combine(basis.v[0], a, basis.v[1], b); };
  const Mat3 nearest = {
      {row(basis.u[0].x, basis.u[1].x), row(basis.u[0].y, basis.u[1].y), row(basis.u[0].z, basis.u[1].z)}};
  StoreWhitened(nearest, whitening, lane, block->F);
  if constexpr (!has_spread) return basis.determines_direction;
  const Vec root_half = Set(0.70710678118654752440);
  Vec f[9];
  for (int i = 0; i < 3; ++i) {
    f[3 * i] = nearest.row[i].x * root_half;
    f[3 * i + 1] = nearest.row[i].y * root_half;
    f[3 * i + 2] = nearest.row[i].z * root_half;
  }
  const SampleLanes<5> sample(*block, lane);
  return hn::And(basis.determines_direction, FillDerivatives(sample, basis, f, whitening, lane, block));
}

template <bool has_spread>
void FillBlock(const RayScale& ray_scale, const EssentialBlock& essentials, HypothesisBlock* block) {
  const Whitening whitening(ray_scale);
  unsigned is_model = 0;
  for (int lane = 0; lane < kBlockSize; lane += kLanes) {
    is_model |= ReadMaskBits(FillLanes<has_spread>(essentials, whitening, lane, block)) << lane;
  }
  block->is_model = static_cast<std::uint8_t>(is_model);
}

void FillExactModels(const RayScale& ray_scale, const EssentialBlock& essentials, HypothesisBlock* block) {
  FillBlock<false>(ray_scale, essentials, block);
}
void FillUncertainExactModels(const RayScale& ray_scale, const EssentialBlock& essentials,
                              HypothesisBlock* block) {
  FillBlock<true>(ray_scale, essentials, block);
}

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rcme {

HWY_EXPORT(FillExactModels);
HWY_EXPORT(FillUncertainExactModels);

void InstantiateExactModels(const RayScale& ray_scale, const EssentialBlock& essentials,
                            RequestedOutputs outputs, HypothesisBlock* block) {
  if (outputs == RequestedOutputs::kNone) {
    HWY_DYNAMIC_DISPATCH(FillExactModels)(ray_scale, essentials, block);
  } else {
    HWY_DYNAMIC_DISPATCH(FillUncertainExactModels)(ray_scale, essentials, block);
  }
}

}  // namespace rcme
#endif
