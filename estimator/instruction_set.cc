#include "estimator/instruction_set.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "estimator/instruction_set.cc"
#include <hwy/foreach_target.h>
// The above must come before this.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

std::int64_t Target() { return HWY_TARGET; }

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rcme {

HWY_EXPORT(Target);

// Uses the kernels' dispatch, so it names the instruction set that they use.
std::string InstructionSetName() {
  switch (const std::int64_t target = HWY_DYNAMIC_DISPATCH(Target)()) {
    case HWY_SCALAR:
    case HWY_EMU128:
      return "scalar";
    case HWY_AVX3:
      return "AVX-512";
    default:
      return hwy::TargetName(target);
  }
}

}  // namespace rcme
#endif
