#include "tests/benchmarks/fma_peak.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/benchmarks/fma_peak.cc"
#include <hwy/foreach_target.h>
// The above must come before these.
#include "estimator/kernels/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

// Nothing is loaded in the loop: the chains x <- a x + b and their two operands fit into the 16 registers of
// AVX2.
double MultiplyAdd(double factor, double summand) {
  const Vec a = Set(factor), b = Set(summand);
  Vec x[kFmaChains];
  for (int i = 0; i < kFmaChains; ++i) x[i] = Set(i);
  for (int step = 0; step < kFmaSteps; ++step) {
    for (int i = 0; i < kFmaChains; ++i) x[i] = hn::MulAdd(x[i], a, b);
  }
  Vec total = Set(0.0);
  for (int i = 0; i < kFmaChains; ++i) total = total + x[i];
  return hn::GetLane(hn::SumOfLanes(Tag(), total));
}

int CountLanes() { return kLanes; }
const char* NameOfTarget() { return hwy::TargetName(HWY_TARGET); }

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rcme {

HWY_EXPORT(MultiplyAdd);
HWY_EXPORT(CountLanes);
HWY_EXPORT(NameOfTarget);

double RunFusedMultiplyAdds() {
  volatile double factor = 0.999, summand = 0.001;  // the compiler does not know them
  return HWY_DYNAMIC_DISPATCH(MultiplyAdd)(factor, summand);
}

int LanesPerVector() { return HWY_DYNAMIC_DISPATCH(CountLanes)(); }
std::string InstructionSet() { return HWY_DYNAMIC_DISPATCH(NameOfTarget)(); }

}  // namespace rcme
#endif
