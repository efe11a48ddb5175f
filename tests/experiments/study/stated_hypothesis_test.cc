#include "experiments/study/stated_hypothesis.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "experiments/study/study_plan.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/small_study.h"

namespace rcme {
namespace {

Study StudyWithHypotheses(const std::string& hypotheses) {
  return ParseStudy(SmallStudyYaml() + "hypotheses:\n" + hypotheses, "h.yaml");
}

TEST(StatedHypothesis, ReadsEveryKindAndWritesItAgain) {
  const Study study = StudyWithHypotheses(
      "  - {quantity: failure, estimator: ours, against: standard, direction: lower, margin: 0.02}\n"
      "  - {quantity: auc_10_deg, estimator: ours, against: standard, direction: higher}\n"
      "  - {quantity: success, estimator: ours, against: standard, direction: not_lower, margin: 0.1}\n"
      "  - {quantity: failure, estimator: ours, against: standard, direction: not_higher, margin: 0.01}\n"
      "  - {quantity: nees_coverage, estimator: ours, at_least: 0.93, where: {outlier_ratio: 0.3}}\n"
      "  - {quantity: failure, estimator: standard, at_most: 0.5}\n");
  std::vector<std::string> said;
  for (const StatedHypothesis& hypothesis : study.hypotheses) said.push_back(Describe(hypothesis));
  EXPECT_EQ(said,
            (std::vector<std::string>{"failure of ours is lower than that of standard by more than 0.02",
                                      "auc_10_deg of ours is higher than that of standard",
                                      "success of ours is not lower than that of standard by 0.1 or more",
                                      "failure of ours is not higher than that of standard by 0.01 or more",
                                      "nees_coverage of ours is at least 0.93 where outlier_ratio = 0.3",
                                      "failure of standard is at most 0.5"}));
  const std::string yaml = ToYaml(study);
  EXPECT_EQ(ToYaml(ParseStudy(yaml, "again.yaml")), yaml);
}

TEST(StatedHypothesis, NoRunDependsOnIt) {
  const Study study = StudyWithHypotheses("  - {quantity: failure, estimator: ours, at_most: 0.5}\n");
  EXPECT_EQ(MakePlan(study).identity, MakePlan(SmallStudy()).identity);
  EXPECT_NE(MakePlan(study).study_yaml, MakePlan(SmallStudy()).study_yaml);
}

TEST(StatedHypothesis, ErrorsNameFileLineKeyValueAndWhatIsAllowed) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> cases = {
      {"{quantity: failures, estimator: ours, at_most: 0.5}",
       {"quantity", "'failures' is not allowed", "did you mean 'failure'", "nees_coverage"}},
      {"{quantity: time_ms, estimator: ours, at_most: 0.5}", {"quantity", "'time_ms'"}},
      {"{quantity: failure, estimator: rcme, at_most: 0.5}",
       {"estimator", "'rcme' is not allowed", "standard, ours"}},
      {"{quantity: failure, estimator: ours, at_most: 50}", {"at_most", "'50'", "a number in [0, 1]"}},
      {"{quantity: failure, estimator: ours, at_most: nan}", {"at_most", "'nan'"}},
      {"{quantity: failure, estimator: ours}", {"give one of: at_least, at_most, direction"}},
      {"{quantity: failure, estimator: ours, at_least: 0.1, at_most: 0.2}", {"give one of"}},
      {"{quantity: failure, estimator: ours, direction: lower}", {"direction and against need each other"}},
      {"{quantity: failure, estimator: ours, against: standard, at_most: 0.1}",
       {"direction and against need each other"}},
      {"{quantity: failure, estimator: ours, against: ours, direction: lower}", {"'ours'", "itself"}},
      {"{quantity: failure, estimator: ours, against: standard, direction: smaller}",
       {"direction", "'smaller'", "not_higher"}},
      {"{quantity: failure, estimator: ours, against: standard, direction: not_higher}",
       {"margin", "greater than 0"}},
      {"{quantity: failure, estimator: ours, at_most: 0.5, margin: 0.1}", {"margin: needs direction"}},
      {"{estimator: ours, at_most: 0.5}", {"key 'quantity' is missing"}},
      {"{quantity: failure, at_most: 0.5}", {"key 'estimator' is missing"}},
      {"{quantity: failure, estimator: ours, at_most: 0.5, alpha: 0.1}", {"unknown key 'alpha'"}},
      {"{quantity: failure, estimator: ours, at_most: 0.5, where: {outlier_ratio: 0.31}}",
       {"where: outlier_ratio", "'0.31'", "0, 0.3"}},
      {"{quantity: failure, estimator: ours, at_most: 0.5, where: {sigma_px: 0.5}}",
       {"where", "'sigma_px' is no factor", "outlier_ratio"}},
  };
  for (const auto& [entry, fragments] : cases) {
    std::vector<std::string> all = fragments;
    all.emplace_back("h.yaml:11:");
    EXPECT_TRUE(ThrowsInputError([&, &entry = entry] { StudyWithHypotheses("  - " + entry + "\n"); }, all))
        << entry;
  }
  EXPECT_TRUE(ThrowsInputError([] { StudyWithHypotheses("  {}\n"); }, {"a list of at least one"}));
}

}  // namespace
}  // namespace rcme
