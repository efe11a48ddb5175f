// An estimator of a user's own program with options of its own: a study, an estimator file, `--set` and the
// tuner see those and no others.
#include <gtest/gtest.h>

#include "experiments/study/estimator_file.h"
#include "experiments/trial/trial.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/test_estimators.h"
#include "tests/test_support/tuned_study.h"

namespace rcme {
namespace {

const std::string kItsOptions = "its options: min_inliers, effort";

class PeerOptions : public testing::Test {
 protected:
  PeerOptions() { AddTestEstimators(); }
  static std::string Entry(const std::string& options) {
    return "  - {name: peer, options: {" + options + "}}\n";
  }
  // Without those of the gate, which every estimator has.
  static Settings OwnOptions(const EstimatorSpec& spec) {
    return {spec.options.begin(), spec.options.begin() + 2};
  }
  static Study WithPeer(const std::string& options) {
    return ParseStudy(SmallStudyYaml() + Entry(options), "peer.yaml");
  }
};

TEST_F(PeerOptions, InAStudy) {
  const Study study = WithPeer("effort: high");
  EXPECT_EQ(OwnOptions(study.estimators[2]), (Settings{{"min_inliers", "8"}, {"effort", "high"}}));
  EXPECT_EQ(ReadOption(study.estimators[2], "model_choice"), "off");
  EXPECT_EQ(ToYaml(ParseStudy(ToYaml(study), "again.yaml")), ToYaml(study));
  EXPECT_NE(MakePlan(study).identity, MakePlan(WithPeer("effort: low")).identity);
  EXPECT_TRUE(ThrowsInputError([] { WithPeer("mu: 3"); },
                               {"peer.yaml:10:", "estimator peer has no option 'mu'", kItsOptions}));
  EXPECT_TRUE(ThrowsInputError([] { WithPeer("min_inliers: -1"); },
                               {"peer.yaml:10:", "min_inliers", "'-1'", "a whole number in [0, 1000]"}));
}

TEST_F(PeerOptions, HaveTheirEffectInATrial) {
  const StudyPlan free = MakePlan(WithPeer("min_inliers: 0")),
                  strict = MakePlan(WithPeer("min_inliers: 1000"));
  EXPECT_FALSE(HasRefused(RunTrial(free, free.conditions[0], 0).records[2]));
  EXPECT_TRUE(HasRefused(RunTrial(strict, strict.conditions[0], 0).records[2]));
}

TEST_F(PeerOptions, InAnEstimatorFile) {
  const EstimatorSpec spec = ParseEstimatorFile("name: peer\noptions: {min_inliers: 9}\n", "peer.yaml");
  EXPECT_EQ(ReadOption(spec, "min_inliers"), "9");
  EXPECT_EQ(ParseEstimatorFile(EstimatorFileText(spec, {}), "again.yaml").options, spec.options);
  EXPECT_TRUE(ThrowsInputError([] { ParseEstimatorFile("name: peer\noptions:\n  kappa: 1\n", "peer.yaml"); },
                               {"peer.yaml:3:", "no option 'kappa'", kItsOptions}));
}

TEST_F(PeerOptions, OnTheCommandLine) {
  Study study = WithPeer("");
  Override(&study, "effort", "high");
  Override(&study, "peer.min_inliers", "12");
  Override(&study, "num_iterations", "30");  // of those that have it
  EXPECT_EQ(OwnOptions(study.estimators[2]), (Settings{{"min_inliers", "12"}, {"effort", "high"}}));
  EXPECT_EQ(ReadOption(study.estimators[1], "num_iterations"), "30");
  EXPECT_TRUE(ThrowsInputError([&] { Override(&study, "peer.num_iterations", "30"); },
                               {"estimator peer has no option 'num_iterations'", kItsOptions}));
}

TEST_F(PeerOptions, InATuning) {
  const StudyPlan plan =
      TunedPlan("  options: {min_inliers: [0, 50, 1000], effort: [low, high]}\n", "peer", Entry(""));
  const SettingPlan settings = MakeTunedSettings(plan);
  EXPECT_EQ(settings.groups.size(), 2u) << "min_inliers is a limit: its levels share a call";
  const std::vector<SettingCount> counts = CountOutcomes(plan, settings, {0, 10})[0];
  EXPECT_EQ(counts[0].false_refusals, 0);
  EXPECT_GT(counts[0].good, 0);
  EXPECT_EQ(counts[4].refusals, 10);
  EXPECT_EQ(counts[4].false_refusals, counts[0].good) << "without its limit it refuses nothing";
  EXPECT_TRUE(ThrowsInputError([] { TunedPlan("  options:\n    mu: [1, 2]\n", "peer", Entry("")); },
                               {"tuned.yaml:14:", "estimator peer has no option 'mu'", kItsOptions}));
  EXPECT_TRUE(
      ThrowsInputError([] { TunedPlan("  options:\n    mu: [1, 2]\n", "standard"); },
                       {"tuned.yaml:13:", "estimator standard has no option 'mu'", "num_iterations"}));
}

// Nothing is refused falsely where nothing is refused because of an option.
TEST_F(PeerOptions, ATargetThatMeansNothingIsRefused) {
  const StudyPlan plan =
      TunedPlan("  target: false_refusal\n  options: {num_iterations: [10, 20]}\n", "standard");
  EXPECT_TRUE(ThrowsInputError([&] { MakeTunedSettings(plan); }, {"false_refusal", "standard", "limit"}));
}

}  // namespace
}  // namespace rcme
