#include "stats/portable_math.h"

#include "stats/portable_math-inl.h"

namespace rcme {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
constexpr hn::CappedTag<double, 1> kOneLane;  // of the baseline: one lane needs no better

}  // namespace

double PortableLog(double x) {
  return hn::GetLane(HWY_NAMESPACE::ComputeLog(kOneLane, hn::Set(kOneLane, x)));
}

CosSin PortableCosSinOfTurn(double u) {
  const HWY_NAMESPACE::CosSinOf turn(kOneLane, hn::Set(kOneLane, u));
  return {hn::GetLane(turn.cos), hn::GetLane(turn.sin)};
}

}  // namespace rcme
