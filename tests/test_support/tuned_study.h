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

inline SettingPlan SettingsOf(const StudyPlan& plan) {
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
