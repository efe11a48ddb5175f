// Kernels once on every instruction set of this machine.
#pragma once

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <functional>

namespace rcme {

// Plain code, AVX2 and AVX-512, as far as the machine has them; then its best again.
inline void RunOnEveryTarget(const std::function<void()>& check) {
  for (const std::int64_t target : {HWY_SCALAR, HWY_AVX2, HWY_AVX3}) {
    if (target != HWY_SCALAR && (hwy::SupportedTargets() & target) == 0) continue;
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::GetChosenTarget().Update(target);
    check();
  }
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

// For a check that may leave by an assertion.
class OnEveryTarget : public testing::Test {
 protected:
  static void Run(const std::function<void()>& check) { RunOnEveryTarget(check); }
  void TearDown() override { hwy::GetChosenTarget().Update(hwy::SupportedTargets()); }
};

}  // namespace rcme
