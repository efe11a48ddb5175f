#include "experiments/gate/gate_terms.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

TEST(RequireSameTerms, SaysWhatIsOther) {
  const GateTerms terms = MakeGateTerms(MakeGateTests({"failure"}, {"failure=0.01"}), "old", {});
  ASSERT_EQ(terms.builds.size(), 1U);
  EXPECT_NO_THROW(RequireSameTerms(terms, terms.AsStoppingRule(), "trials.sqlite"));

  const GateTerms of_other_margin = MakeGateTerms(MakeGateTests({"failure"}, {"failure=0.05"}), "old", {});
  EXPECT_TRUE(
      ThrowsInputError([&] { RequireSameTerms(of_other_margin, terms.AsStoppingRule(), "trials.sqlite"); },
                       {"trials.sqlite", "failure=0.01", "failure=0.05", "another --out"}));
  GateTerms of_other_build = terms;
  of_other_build.builds[0].back() = terms.builds[0].back() == '0' ? '1' : '0';
  EXPECT_TRUE(
      ThrowsInputError([&] { RequireSameTerms(of_other_build, terms.AsStoppingRule(), "trials.sqlite"); },
                       {"trials.sqlite", "another build of rcme"}));
  EXPECT_TRUE(
      ThrowsInputError([&] { RequireSameTerms(terms, "ci=0.01", "trials.sqlite"); }, {"known margins"}));
}

// A label says nothing of what gave the trials: the estimator, its options and the program do.
TEST(RecordedVersions, AreComparedByWhatTheyAre) {
  const RecordedVersion before{
      {"ours", "five_point", "", {{"num_iterations", "100"}, {"sigma", "1"}, {"leave_out", "none"}}},
      {"rcme 0.1.0", "avx2"},
      ""};
  RecordedVersion after = before;
  EXPECT_EQ(IdentifyVersion(before), IdentifyVersion(after));
  EXPECT_FALSE(HasMisleadingLabel(before, after));
  EXPECT_EQ(
      CompareVersions(before, after),
      "old: five_point of rcme 0.1.0 (avx2); new: the same estimator with the same options, of rcme 0.1.0 "
      "(avx2)");
  after.origin.program = "rcme 0.2.0";
  EXPECT_NE(IdentifyVersion(before), IdentifyVersion(after));
  after.estimator.options[0].second = "200";
  EXPECT_TRUE(HasMisleadingLabel(before, after));
  EXPECT_EQ(
      CompareVersions(before, after),
      "old: five_point of rcme 0.1.0 (avx2); new: the same estimator with other options (num_iterations "
      "200, not 100), of rcme 0.2.0 (avx2)");
  after.estimator.options = {{"num_iterations", "100"}, {"sigma", "1"}, {"solver", "five_point"}};
  EXPECT_THAT(CompareVersions(before, after),
              testing::HasSubstr("other options (solver five_point, not known before, no leave_out)"));
  after.estimator.name = "magsac";
  EXPECT_EQ(CompareVersions(before, after),
            "old: five_point of rcme 0.1.0 (avx2); new: another estimator, magsac, of rcme 0.2.0 (avx2)");
  after.estimator.label = "theirs";
  EXPECT_FALSE(HasMisleadingLabel(before, after));

  const std::vector<GateTest> tests = MakeGateTests({"failure"}, {});
  const GateTerms terms = MakeGateTerms(tests, "ours", {}, IdentifyVersion(before)),
                  of_other_baseline = MakeGateTerms(tests, "ours", {}, IdentifyVersion(after));
  EXPECT_NO_THROW(RequireSameTerms(terms, terms.AsStoppingRule(), "trials.sqlite"));
  EXPECT_TRUE(
      ThrowsInputError([&] { RequireSameTerms(of_other_baseline, terms.AsStoppingRule(), "trials.sqlite"); },
                       {"trials.sqlite", "another build of the baseline's version ours"}));
}

}  // namespace
}  // namespace rcme
