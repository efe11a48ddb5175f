// The weights after the check are still probabilities.
#include "estimator/calibrated/modes_verdict.h"

#include <gtest/gtest.h>

#include <numeric>

namespace rcme {
namespace {

// Two modes that are the answer, two rivals, the rest of no motion.
ModeWeights SomeWeights() {
  ModeWeights weights;
  weights.of_modes = {0.6, 0.1, 0.15, 0.05};
  weights.is_rival = {false, false, true, true};
  weights.is_second_motion = {false, false, false, false};
  weights.of_no_motion = 0.1;
  return weights;
}
double Total(const ModeWeights& weights) {
  return std::accumulate(weights.of_modes.begin(), weights.of_modes.end(), weights.of_no_motion);
}

TEST(ReweighModes, WhatTheCheckAddsIsOfNoMode) {
  const ModesVerdict verdict{.by_modes = 0.3, .failure_probability = 0.65};
  const ModeWeights after = ReweighModes(SomeWeights(), verdict);
  EXPECT_NEAR(Total(after), 1.0, 1e-12);
  EXPECT_NEAR(after.of_modes[0] + after.of_modes[1], 0.35, 1e-12);
  EXPECT_NEAR(after.of_modes[2], 0.075, 1e-12);  // as much less as the answer
  EXPECT_NEAR(after.of_no_motion, 0.55, 1e-12);
}

TEST(ReweighModes, WhatTheCheckTakesAwayIsTakenFromTheRivals) {
  const ModesVerdict verdict{.by_modes = 0.3, .failure_probability = 0.15};
  const ModeWeights after = ReweighModes(SomeWeights(), verdict);
  EXPECT_NEAR(Total(after), 1.0, 1e-12);
  EXPECT_NEAR(after.of_modes[0] + after.of_modes[1], 0.85, 1e-12);
  EXPECT_NEAR(after.of_modes[0] / after.of_modes[1], 6.0, 1e-9);
  EXPECT_NEAR(after.of_modes[2], 0.075, 1e-12);
  EXPECT_NEAR(after.of_no_motion, 0.05, 1e-12);
}

// Where the modes see no failure at all there is nothing to divide by.
TEST(ReweighModes, ModesWithoutADoubtAreDoubtedAllTheSame) {
  ModeWeights weights;
  weights.of_modes = {1.0};
  weights.is_rival = weights.is_second_motion = {false};
  const ModeWeights after = ReweighModes(weights, {.by_modes = 0.0, .failure_probability = 0.01});
  EXPECT_NEAR(after.of_modes[0], 0.99, 1e-12);
  EXPECT_NEAR(after.of_no_motion, 0.01, 1e-12);
}

// Without the check both are the same, 0 and 1 among them.
TEST(ReweighModes, NothingChangesWithoutTheCheck) {
  for (const double p : {0.0, 0.3, 1.0}) {
    const ModeWeights before = SomeWeights(),
                      after = ReweighModes(before, {.by_modes = p, .failure_probability = p});
    EXPECT_EQ(after.of_modes, before.of_modes);
    EXPECT_EQ(after.of_no_motion, before.of_no_motion);
  }
}

}  // namespace
}  // namespace rcme
