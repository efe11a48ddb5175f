// An estimator that states the probability of a failure means the failure of its study.
#include <gtest/gtest.h>

#include "experiments/study/study_file.h"
#include "tests/test_support/expect_input_error.h"

namespace rcme {
namespace {

std::string StudyWith(const std::string& estimator) {
  std::string yaml = "name: bounds\ndata: {scene: uniform_volume, num_matches: 60}\nestimators:\n  - ";
  yaml += estimator;
  yaml += "\nfailure: {max_rotation_error_deg: 5, max_direction_error_deg: 10}\n";
  return yaml;
}

std::string Option(const Study& study, const std::string& name) {
  for (const auto& [option, value] : study.estimators.at(0).options) {
    if (option == name) return value;
  }
  return "(none)";
}

TEST(FailureBoundsOfEstimators, AreThoseOfTheStudy) {
  const Study study = ParseStudy(StudyWith("{name: rcme_calibrated}"), "bounds.yaml");
  EXPECT_EQ(Option(study, "max_rotation_error_deg"), "5");
  EXPECT_EQ(Option(study, "max_direction_error_deg"), "10");
  EXPECT_EQ(ToYaml(ParseStudy(ToYaml(study), "again.yaml")), ToYaml(study));
}

TEST(FailureBoundsOfEstimators, AreTheirOwnWhereGiven) {
  const Study study =
      ParseStudy(StudyWith("{name: rcme_calibrated, options: {max_rotation_error_deg: 3}}"), "bounds.yaml");
  EXPECT_EQ(Option(study, "max_rotation_error_deg"), "3");
  EXPECT_EQ(Option(study, "max_direction_error_deg"), "10");
}

TEST(FailureBoundsOfEstimators, ThatAnEstimatorCannotTakeNameTheirLineAndTheEstimator) {
  std::string yaml = StudyWith("{name: rcme_calibrated, label: ours}");
  yaml.replace(yaml.find("error_deg: 5"), 12, "error_deg: 0");
  EXPECT_TRUE(ThrowsInputError([&] { ParseStudy(yaml, "bounds.yaml"); },
                               {"bounds.yaml:5: failure: the estimator 'ours' takes this bound",
                                "max_rotation_error_deg: '0' is not allowed"}));
}

TEST(FailureBoundsOfEstimators, AreNoneOfAnEstimatorThatStatesNoProbability) {
  const Study study = ParseStudy(StudyWith("{name: standard}"), "bounds.yaml");
  EXPECT_EQ(Option(study, "max_rotation_error_deg"), "(none)");
}

TEST(FailureBoundsOfEstimators, AreSetWithTheStudys) {
  Study study = ParseStudy(StudyWith("{name: rcme_calibrated}"), "bounds.yaml");
  Override(&study, "max_rotation_error_deg", "7");
  EXPECT_EQ(study.failure.max_rotation_error_deg, 7.0);
  EXPECT_EQ(Option(study, "max_rotation_error_deg"), "7");
  Override(&study, "rcme_calibrated.max_rotation_error_deg", "2");
  EXPECT_EQ(study.failure.max_rotation_error_deg, 7.0);
  EXPECT_EQ(Option(study, "max_rotation_error_deg"), "2");
}

}  // namespace
}  // namespace rcme
