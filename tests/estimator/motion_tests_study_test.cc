// What the tests of a refined motion (observability.h, motion_chance.h) refuse and what they let pass, in
// short. At length: tests/studies/motion_tests_main.cc.
#include <gtest/gtest.h>

#include "tests/test_support/motion_outcomes.h"

namespace rcme::motion_tests {
namespace {

// Whatever the estimator, an answer without a motion behind it has probability 0.001 at most; 5 of 300 have
// probability 3e-5 then. Without the tests there are plenty, so that a test which never refuses is caught.
TEST(MotionTests, NoMotionIsRefused) {
  for (const Condition& c : {Condition{World::kPureRotation, 100, 0.3},
                             Condition{World::kZeroMotion, 50, 0.0}, Condition{World::kRandom, 500, 1.0}}) {
    const Counts counts = CountOutcomes(c, "standard", 300);
    EXPECT_LE(counts.ok, 4) << c.Name();
    EXPECT_GE(counts.ok_untested, 60) << c.Name();
    EXPECT_GE(c.world == World::kRandom ? counts.by_chance : counts.not_observable, 60) << c.Name();
  }
}

// Right answers of five degrees of parallax are not refused: 4 of 200 would be, with probability 0.0001, at a
// rate of 0.2 %.
TEST(MotionTests, MotionsAreNotRefused) {
  for (const std::string estimator : {"standard", "rcme"}) {
    const Counts counts = CountOutcomes({World::kParallax, 200, 0.2, 5.0}, estimator, 200);
    EXPECT_GE(counts.right_untested, 150) << estimator;
    EXPECT_LE(counts.right_refused, 3) << estimator;
  }
}

}  // namespace
}  // namespace rcme::motion_tests
