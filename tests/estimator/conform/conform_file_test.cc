#include "estimator/conform/conform_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "estimator/conform/conform_estimator.h"
#include "estimator/estimator_registry.h"
#include "parameters/input_error.h"
#include "tests/estimator/conform/conform_examples.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/family_problem.h"
#include "tests/test_support/mutated.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

std::string ExampleText() { return ConformFileText(ExampleRule(), {"a promise"}); }

TEST(ConformFile, GivesTheRuleBack) {
  const ConformFile file = ParseConformFile(ExampleText(), "x.json");
  EXPECT_EQ(ConformFileText(file.rule, {"a promise"}), ExampleText());
  EXPECT_EQ(file.rule.factors[2], kInfinity);
  EXPECT_EQ(file.rule.options.front().second, "50");
  EXPECT_EQ(file.digest.size(), 16U);
  ConformRule without = ExampleRule();
  without.greatest_log_odds.reset();
  without.familiar.clear();
  without.familiar_features.clear();
  const std::string text = ConformFileText(without, {});
  EXPECT_EQ(ConformFileText(ParseConformFile(text, "x.json").rule, {}), text);
  EXPECT_NE(ParseConformFile(text, "x.json").digest, file.digest);
}

std::string Replaced(const std::string& was, const std::string& now) {
  std::string text = ExampleText();
  const size_t at = text.find(was);
  EXPECT_NE(at, std::string::npos) << was;
  return text.replace(at, was.size(), now);
}

TEST(ConformFile, SaysWhatIsWrong) {
  const auto expect = [](const std::string& text, const std::string& words) {
    EXPECT_TRUE(ThrowsInputError([&] { ParseConformFile(text, "x.json"); }, {"x.json", words}));
  };
  expect("", "is no JSON");
  expect("[1]", "the file is no object");
  expect(std::string(kMaxConformBytes + 1, ' '), "is longer than");
  expect(Replaced("rcme conform 3", "rcme conform 9"), "is of format 'rcme conform 9'");
  expect(Replaced("\"level\"", "\"levels\""), "has no key 'level'");
  expect(Replaced("\"level\": 0.95", "\"level\": \"a\""), "'level' is no number");
  expect(Replaced("\"level\": 0.95", "\"level\": 7"), "'level' is 7, not between 0.5 and 1");
  expect(Replaced("\"all motions\"", "\"none\""), "factors holds something");
  expect(Replaced("\"edges\": [", "\"edges\": [1e9,"), "edges");
  expect(Replaced("\"feature\": \"direction_sd\"", "\"feature\": \"colour\""), "unknown feature");
  expect(Replaced("\"groups\": 21", "\"groups\": -1"), "'groups' is no count");
  expect(Replaced("\"new_groups\": false", "\"new_groups\": 0"), "'new_groups' is neither");
  expect(Replaced("\"name\": \"standard\"", "\"name\": \"standard\", \"extra\": 1"), "unknown key 'extra'");
  expect(Replaced("rcme conform 3", "rcme conform 1"), "write it with `rcme conform`");
  expect(Replaced("\"23456789abcdef01\"", "1"), "'problems' holds something that is no text");
  expect(Replaced("23456789abcdef01", "2345678"), "is not 16 hexadecimal digits");
  expect(Replaced("23456789abcdef01", "0123456789abcdef"), "'problems' is empty or does not ascend");
  expect(Replaced("\"num_iterations\": \"50\"", "\"num_iterations\": 50"), "no text");
}

// Numbers that no calibration writes, changed by hand.
TEST(ConformFile, RefusesNumbersOutOfRange) {
  const auto expect = [](const std::string& text, const std::string& words) {
    EXPECT_TRUE(ThrowsInputError([&] { ParseConformFile(text, "x.json"); }, {"x.json", words}));
  };
  expect(Replaced("\"risk\": 0.05", "\"risk\": -1"), "'risk' is -1, not between 0 and 1");
  expect(Replaced("\"wrong_and_accepted\": 0.02", "\"wrong_and_accepted\": 1"),
         "'wrong_and_accepted' is 1, not between");
  expect(Replaced("\"max_rotation_error_deg\": 3.0", "\"max_rotation_error_deg\": -1"),
         "'max_rotation_error_deg' is -1, not above 0 and at most 180");
  expect(Replaced("\"max_direction_error_deg\": 15.0", "\"max_direction_error_deg\": 181"),
         "'max_direction_error_deg' is 181, not above 0");
  expect(Replaced("\"slope\": 1.0", "\"slope\": -1"), "'slope' is -1, not at least 0");
  expect(Replaced("1.5", "0"), "'factors' holds 0, not a number above 0");
  expect(Replaced("1.5", "-2"), "'factors' holds -2");
  expect(Replaced("\"groups\": 21", "\"groups\": 24"), "'groups' is 24, more than answers and refusals");
  expect(Replaced("\"groups\": 21", "\"groups\": 20"), "21 familiar answers, more than 'groups'");
  expect(Replaced("\"answers\": 21", "\"answers\": 0"), "'answers' is 0");
  expect(Replaced("\"refused_groups\": 1", "\"refused_groups\": 3"), "'refused_groups' is 3, more than");
  ConformRule flat = ExampleRule();
  flat.log_odds_slope = 0.0;
  EXPECT_EQ(ParseConformFile(ConformFileText(flat, {}), "").rule.log_odds_slope, 0.0);
}

// Numbers that a calibration might have written.
TEST(ConformFile, RefusesWhatWasChangedByHand) {
  const auto expect = [](const std::string& text, const std::string& words) {
    EXPECT_TRUE(ThrowsInputError([&] { ParseConformFile(text, "x.json"); }, {"x.json", words}));
  };
  expect(Replaced("\"slope\": 1.0", "\"slope\": 1.5"), "its checksum is another one");
  expect(Replaced("a promise", "another promise"), "its checksum is another one");
  expect(Replaced("\"checksum\"", "\"sum\""), "has no key 'checksum'");
  EXPECT_EQ(ParseConformFile(Replaced("\"slope\": 1.0", "\"slope\":   1.0"), "").rule.log_odds_slope, 1.0);
}

TEST(ConformFile, SaysWhereItIsCutOff) {
  const std::string text = ExampleText();
  EXPECT_TRUE(ThrowsInputError([&] { ParseConformFile(text.substr(0, 200), "x.json"); },
                               {"x.json", "cut off at byte 200"}));
  EXPECT_TRUE(
      ThrowsInputError([&] { ParseConformFile("{\"format\"; 1}", "x.json"); }, {"no JSON at byte 10"}));
}

// Whatever becomes of a file's bytes: a rule or an error that names the file.
TEST(ConformFile, SurvivesDamage) {
  RandomStream rng({.seed = 1, .purpose = 99});
  const std::string text = ExampleText();
  int num_read = 0;
  for (int i = 0; i < 2000; ++i) {
    try {
      ParseConformFile(Mutated(text, {"null", "1e999", "[]", "\"all motions\"", "-"}, rng), "x.json");
      ++num_read;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("x.json"));
    }
  }
  EXPECT_LT(num_read, 100);  // white space, and what changes no value
}

TEST(ConformFile, IsReadFromARegularFileAlone) {
  const TempFolder folder;
  EXPECT_TRUE(
      ThrowsInputError([&] { ReadConformFile(folder.Path("none.json")); }, {"none.json", "cannot be read"}));
  EXPECT_TRUE(ThrowsInputError([&] { ReadConformFile(folder.Path(".")); }, {"is not a file"}));
  const std::string path = folder.Write("x.json", ExampleText());
  EXPECT_EQ(ReadConformFile(path).digest, ParseConformFile(ExampleText(), "").digest);
}

class ConformEstimator : public testing::Test {
 protected:
  std::unique_ptr<MotionEstimator> Make(const Settings& options) {
    const std::unique_ptr<EstimatorModel> model = ConformModel();
    const std::vector<Parameter> parameters = model->Parameters();
    for (const auto& [option, value] : options) FindParameter(parameters, option).SetFromText(value);
    return model->Make();
  }
  TempFolder folder_;
};

TEST_F(ConformEstimator, IsTheOtherWithItsRule) {
  const std::string path = folder_.Write("x.json", ExampleText());
  const std::unique_ptr<MotionEstimator> conformed = Make({{"file", path}, {"accept_rule", "ignore"}});
  const std::unique_ptr<MotionEstimator> own = MakeEstimator("standard", {{"num_iterations", "50"}});
  const ConformJudge judge(ExampleRule());
  const ProblemFamily family("uniform_volume", "sideways", 100, 0.2);
  for (std::uint32_t trial = 0; trial < 5; ++trial) {
    const MotionProblem problem = family.Make(trial);
    RandomStream rng1({.seed = 1}), rng2({.seed = 1});
    const MotionEstimate expected = judge.Apply(problem, own->Estimate(problem, rng1), false),
                         found = conformed->Estimate(problem, rng2);
    EXPECT_EQ(found.status, expected.status);
    EXPECT_EQ(found.pose_cov, expected.pose_cov);
    EXPECT_EQ(found.failure_probability, expected.failure_probability);
  }
}

TEST_F(ConformEstimator, RefusesAFileThatHasChanged) {
  const std::string path = folder_.Write("x.json", ExampleText());
  Settings options = ConformOptions(path);
  EXPECT_NO_THROW(Make(options));
  ConformRule other = ExampleRule();
  other.level = 0.9;
  folder_.Write("x.json", ConformFileText(other, {}));
  EXPECT_TRUE(ThrowsInputError([&] { Make(options); }, {"has changed since"}));
}

TEST_F(ConformEstimator, RefusesItsOwnKindAndUnknownOnes) {
  ConformRule rule = ExampleRule();
  const auto expect = [&](const std::string& estimator, const std::string& words) {
    rule.estimator = estimator;
    const std::string path = folder_.Write(estimator + ".json", ConformFileText(rule, {}));
    EXPECT_TRUE(ThrowsInputError([&] { Make({{"file", path}}); }, {words}));
  };
  expect("conform", "of `conform` itself");
  expect("nobody", "unknown estimator 'nobody'");
}

TEST_F(ConformEstimator, WithoutAFileAnswersNothing) {
  RandomStream rng({.seed = 1});
  const MotionEstimate none =
      Make({})->Estimate(ProblemFamily("uniform_volume", "sideways", 50, 0.0).Make(0), rng);
  EXPECT_EQ(none.status, MotionStatus::kNoAnswer);
}

}  // namespace
}  // namespace rcme
