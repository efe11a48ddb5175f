#include "estimator/kernels/five_point_block.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "estimator/kernels/five_point_block.cc"
#include <hwy/foreach_target.h>
// The above must come before these.
#include "estimator/kernels/five_point_brackets-inl.h"
#include "estimator/kernels/five_point_elimination-inl.h"
#include "estimator/kernels/five_point_null_space-inl.h"
#include "estimator/kernels/five_point_polynomial-inl.h"
#include "estimator/kernels/five_point_recovery-inl.h"
#include "estimator/kernels/five_point_roots-inl.h"
#include "estimator/kernels/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

HWY_INLINE void StoreRow(const PolynomialRow& row, int lane, BlockPolynomials::Row* to) {
  for (int c = 0; c < 4; ++c) {
    Store(row.x[c], to[c] + lane);
    Store(row.y[c], to[4 + c] + lane);
  }
  for (int c = 0; c < 5; ++c) Store(row.one[c], to[8 + c] + lane);
}

// Fills lanes [lane, lane + kLanes), one sample per lane.
void FillPolynomials(const FivePointSamples& samples, int lane, BlockPolynomials* polynomials,
                     NodeValues* values) {
  NullSpace space;
  FindNullSpace(samples, lane, &space);
  Constraints constraints;
  FillConstraints(space, &constraints);
  Eliminate(&constraints);
  const auto row = [&](int r) { return constraints.c[r] + 10; };
  const PolynomialRow B[3] = {MakeRow(row(4), row(5)), MakeRow(row(6), row(7)), MakeRow(row(8), row(9))};
  Vec p[kDegree + 1];
  Determinant(B, p);
  for (Vec& c : p) c = hn::IfThenElseZero(space.is_regular, c);  // zero: no sign changes, so no roots
  EvaluateAtNodes(p, lane, values);
  for (int c = 0; c <= kDegree; ++c) Store(p[c], polynomials->p[c] + lane);
  for (int i = 0; i < 3; ++i) StoreRow(B[i], lane, polynomials->B[i]);
  for (int i = 0; i < 9; ++i) {
    for (int k = 0; k < 4; ++k) Store(space.E[i][k], polynomials->basis[i][k] + lane);
  }
}

// Sorts the models by their samples and leaves out roots that are no models.
void WriteModels(const RecoveredRoots& roots, const Brackets& brackets, FivePointModels* models) {
  int num_models[kBlockSize] = {}, next[kBlockSize];
  for (int root = 0; root < brackets.count; ++root) num_models[brackets.sample[root]] += roots.is_model[root];
  models->begin[0] = 0;
  for (int s = 0; s < kBlockSize; ++s) {
    next[s] = models->begin[s];
    models->begin[s + 1] = models->begin[s] + num_models[s];
  }
  for (int root = 0; root < brackets.count; ++root) {
    if (roots.is_model[root] == 0) continue;
    const int place = next[brackets.sample[root]]++;
    for (int i = 0; i < 9; ++i) models->E[i][place] = roots.E[i][root];
  }
}

// Every f of eight samples, as E (eq::model_instantiate).
void FindModels(const FivePointSamples& samples, FivePointModels* models) {
  BlockPolynomials polynomials;
  Brackets brackets;
  {
    NodeValues values;
    for (int lane = 0; lane < kBlockSize; lane += kLanes)
      FillPolynomials(samples, lane, &polynomials, &values);
    FindBrackets(polynomials, &values, &brackets);
  }
  alignas(64) double t[Brackets::kCapacity];
  RefineRoots(polynomials, brackets, t);
  RecoveredRoots roots;
  RecoverMatrices(polynomials, brackets, t, &roots);
  WriteModels(roots, brackets, models);
}

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rcme {

HWY_EXPORT(FindModels);

void SolveFivePoints(const FivePointSamples& samples, FivePointModels* models) {
  HWY_DYNAMIC_DISPATCH(FindModels)(samples, models);
}

}  // namespace rcme
#endif
