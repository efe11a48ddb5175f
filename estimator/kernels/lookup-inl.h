// Picks a number of a block's samples with an index of its own in every lane.
#if defined(RCME_ESTIMATOR_KERNELS_LOOKUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RCME_ESTIMATOR_KERNELS_LOOKUP_INL_H_
#undef RCME_ESTIMATOR_KERNELS_LOOKUP_INL_H_
#else
#define RCME_ESTIMATOR_KERNELS_LOOKUP_INL_H_
#endif

#include <cstdint>

#include "estimator/kernels/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

// Picks row[index of the lane] from rows of eight numbers. The indices are 0 to 7, one per lane.
class Lookup {
 public:
  using IndexTag = hn::RebindToSigned<Tag>;
  HWY_INLINE explicit Lookup(hn::Vec<IndexTag> indices);
  // `indices` is aligned
  explicit Lookup(const std::int64_t* indices) : Lookup(hn::Load(IndexTag(), indices)) {}
  HWY_INLINE Vec operator()(const double* row) const;

 private:
#if HWY_TARGET == HWY_SCALAR
  std::int64_t index_;
#else
  decltype(hn::IndicesFromVec(Tag(), hn::Zero(IndexTag()))) within_;  // index within one vector
  Mask is_upper_;  // the number is in the second vector of the row
  hn::Vec<IndexTag> indices_;
#endif
};

#if HWY_TARGET == HWY_SCALAR
HWY_INLINE Lookup::Lookup(hn::Vec<IndexTag> indices) : index_(indices.raw) {}
HWY_INLINE Vec Lookup::operator()(const double* row) const { return Vec(row[index_]); }
#else
HWY_INLINE Lookup::Lookup(hn::Vec<IndexTag> indices)
    : within_(hn::IndicesFromVec(Tag(), hn::And(indices, hn::Set(IndexTag(), std::int64_t{kLanes - 1})))),
      is_upper_(hn::RebindMask(Tag(), indices > hn::Set(IndexTag(), std::int64_t{kLanes - 1}))),
      indices_(indices) {}
HWY_INLINE Vec Lookup::operator()(const double* row) const {
  if constexpr (kLanes == 8) return hn::TableLookupLanes(Load(row), within_);
  if constexpr (kLanes == 4) {
    return hn::IfThenElse(is_upper_, hn::TableLookupLanes(Load(row + kLanes % 8), within_),
                          hn::TableLookupLanes(Load(row), within_));
  }
  return hn::GatherIndex(Tag(), row, indices_);
}
#endif

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
