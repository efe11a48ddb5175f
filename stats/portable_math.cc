#include "stats/portable_math.h"

#include "stats/portable_math-inl.h"

namespace rcme {
namespace {

namespace one_target = HWY_NAMESPACE;  // the baseline: one lane needs no other
using OneLane = hwy::HWY_NAMESPACE::CappedTag<double, 1>;
constexpr OneLane kOneLane;

}  // namespace

double PortableLog(double x) {
  namespace hn = hwy::HWY_NAMESPACE;
  return hn::GetLane(one_target::LogOf(kOneLane, hn::Set(kOneLane, x)));
}

CosSin PortableCosSinOfTurn(double u) {
  namespace hn = hwy::HWY_NAMESPACE;
  const one_target::CosSinOf turn(kOneLane, hn::Set(kOneLane, u));
  return {hn::GetLane(turn.cos), hn::GetLane(turn.sin)};
}

}  // namespace rcme
