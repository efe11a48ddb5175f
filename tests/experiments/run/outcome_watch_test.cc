#include "experiments/run/outcome_watch.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/study/study_file.h"

namespace rcme {
namespace {

using testing::HasSubstr;

TrialResult NotSimulatedTrial(std::uint32_t trial, const std::string& why) {
  TrialResult result;
  result.problem.trial = trial;
  result.records.resize(1);
  result.records[0].status = MotionStatus::kNotSimulated;
  result.why_not_simulated = why;
  return result;
}

TEST(OutcomeWatch, CountsTheReasonsOfTrialsThatCannotBeSimulated) {
  const StudyPlan plan = MakePlan(ParseStudy(
      "data: {scene: plane, num_matches: 30}\ntrials: 20\nestimators: [{name: standard}]\n", "study.yaml"));
  OutcomeWatch watch;
  std::uint32_t trial = 0;
  for (const auto& [reason, count] : std::vector<std::pair<std::string, int>>{
           {"a", 1}, {"b", 2}, {"c", 3}, {"d", 4}, {"e", 1}, {"f", 1}, {"g", 5}}) {
    for (int i = 0; i < count; ++i, ++trial)
      watch.Add(NotSimulatedTrial(trial, fmt::format("{}: {} is too large: give less", reason, i)));
  }
  testing::internal::CaptureStderr();
  watch.Warn(plan, "run.sqlite");
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_THAT(text, HasSubstr("17 of the 17 trials"));
  EXPECT_THAT(text, HasSubstr("Trials by reason: g 5, d 4, c 3, b 2, a 1, other reasons 2."));
  EXPECT_THAT(text, HasSubstr("Condition 0, trial 0: a: 0 is too large: give less"));
}

TEST(OutcomeWatch, NamesTheFirstTrialWithoutAnAnswer) {
  const StudyPlan plan = MakePlan(ParseStudy(
      "data: {scene: plane, num_matches: 30}\ntrials: 20\nestimators: [{name: standard}]\n", "study.yaml"));
  OutcomeWatch watch;
  for (const std::uint32_t trial : {9, 7, 8}) {
    TrialResult result;
    result.problem.condition = 2;
    result.problem.trial = trial;
    result.records.resize(1);
    result.records[0].status = trial == 8 ? MotionStatus::kOk : MotionStatus::kNoAnswer;
    watch.Add(result);
  }
  testing::internal::CaptureStderr();
  watch.Warn(plan, "run.sqlite");
  EXPECT_EQ(
      testing::internal::GetCapturedStderr(),
      "warning: standard gave no answer in 2 of the 3 trials run now (no_answer 2); rcme replay run.sqlite "
      "--condition 2 --trial 7 shows why\n");
}

}  // namespace
}  // namespace rcme
