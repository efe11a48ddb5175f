// The small study with a tune block, and what a tuning's counts are as text.
#pragma once

#include <fmt/format.h>

#include <string>

#include "experiments/tuning/setting_counts.h"
#include "tests/test_support/small_study.h"

namespace rcme {

// `tune`: the lines of the block after its estimator; `more`: further estimators of the study.
inline std::string TunedYaml(const std::string& tune, const std::string& estimator = "ours",
                             const std::string& more = "") {
  return SmallStudyYaml() + more + "tune:\n  estimator: " + estimator + "\n" + tune;
}

inline StudyPlan TunedPlan(const std::string& tune, const std::string& estimator = "ours",
                           const std::string& more = "") {
  return MakePlan(ParseStudy(TunedYaml(tune, estimator, more), "tuned.yaml"));
}

// Three, five and four pieces of each condition, some of fewer than ten trials.
inline StudyPlan PlanInPieces() {
  return TunedPlan(
      "  target: failure\n"
      "  at_most: 0.3\n"
      "  max_refusal: 0.9\n"
      "  explore: 25\n"
      "  calibrate: 47\n"
      "  verify: 33\n"
      "  options: {mu: [1, 2, 3, 6]}\n");
}

inline SettingPlan MakeTunedSettings(const StudyPlan& plan) {
  return MakeSettingPlan(plan.study, *plan.study.tuning);
}

inline std::string Text(const std::vector<SettingCount>& counts) {
  std::string text;
  for (const SettingCount& c : counts) {
    text += fmt::format("n {} failures {} refusals {} good {} false refusals {}\n", c.n, c.failures,
                        c.refusals, c.good, c.false_refusals);
  }
  return text;
}

}  // namespace rcme
