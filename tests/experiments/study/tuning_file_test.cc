#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "experiments/study/study_file.h"
#include "experiments/study/study_plan.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/small_study.h"

namespace rcme {
namespace {

using Levels = std::vector<std::string>;

// The small study with a tuning; the block begins in line 10, the options in line 15.
std::string TuningYaml() {
  std::string yaml = SmallStudyYaml();
  yaml +=
      "tune:\n"
      "  estimator: ours\n"
      "  target: false_refusal\n"
      "  at_most: 0.1\n"
      "  explore: 20\n"
      "  options:\n"
      "    mu: {from: 0, to: 1.2, step: 0.3}\n"
      "    lambda: [0.5, 0.8, 1.0]\n"
      "    selection: [mean_entropy, predictive_likelihood]\n";
  return yaml;
}

std::string EditedTuning(const std::string& from, const std::string& to) {
  std::string yaml = TuningYaml();
  const size_t at = yaml.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return yaml.replace(at, from.size(), to);
}

const std::string kSteps = "{from: 0, to: 1.2, step: 0.3}";

Levels LevelsOfMu(const std::string& given) {
  return ParseStudy(EditedTuning(kSteps, given), "levels.yaml").tuning->options[0].levels;
}

testing::AssertionResult RefusesTuning(const std::string& yaml, std::vector<std::string> fragments) {
  fragments.push_back("bad.yaml:");
  return ThrowsInputError([&] { ParseStudy(yaml, "bad.yaml"); }, fragments);
}

testing::AssertionResult RefusesLevels(const std::string& given, std::vector<std::string> fragments) {
  fragments.push_back("bad.yaml:16: ");
  return RefusesTuning(EditedTuning(kSteps, given), fragments);
}

TEST(TuneBlock, ReadsEveryPart) {
  const Study study = ParseStudy(TuningYaml(), "tuned.yaml");
  ASSERT_TRUE(study.tuning.has_value());
  const Tuning& tuning = *study.tuning;
  EXPECT_EQ(tuning.estimator, "ours");
  EXPECT_EQ(tuning.target, TuneTarget::kFalseRefusal);
  EXPECT_EQ(tuning.at_most, 0.1);
  EXPECT_EQ(tuning.explore, 20);
  EXPECT_EQ(tuning.calibrate, 400);
  EXPECT_EQ(tuning.delta, 0.05);
  ASSERT_EQ(tuning.options.size(), 3u);
  EXPECT_EQ(tuning.options[0].name, "mu");
  EXPECT_EQ(tuning.options[0].levels, (Levels{"0", "0.3", "0.6", "0.9", "1.2"}));
  EXPECT_EQ(tuning.options[1].name, "lambda");
  EXPECT_EQ(tuning.options[1].levels, (Levels{"0.5", "0.8", "1"}));
  EXPECT_EQ(tuning.options[2].name, "selection");
  EXPECT_EQ(tuning.options[2].levels, (Levels{"mean_entropy", "predictive_likelihood"}));
  EXPECT_FALSE(SmallStudy().tuning.has_value());
}

TEST(TuneBlock, MayComeBeforeTheEstimators) {
  const std::string block = TuningYaml().substr(SmallStudyYaml().size());
  EXPECT_EQ(ParseStudy(block + SmallStudyYaml(), "a.yaml").tuning->estimator, "ours");
}

TEST(TuneBlock, LevelsByStepsHaveNoRoundingNoise) {
  EXPECT_EQ(LevelsOfMu("{from: -0.3, to: 0.3, step: 0.1}"),
            (Levels{"-0.3", "-0.2", "-0.1", "0", "0.1", "0.2", "0.3"}));
  EXPECT_EQ(LevelsOfMu("{from: 0, to: 1, step: 0.4}"), (Levels{"0", "0.4", "0.8"}));
  EXPECT_EQ(LevelsOfMu("{from: 2, to: 2, step: 1}"), (Levels{"2"}));
  EXPECT_EQ(LevelsOfMu("{from: 0.125, to: 1, step: 2.5e-1}"), (Levels{"0.125", "0.375", "0.625", "0.875"}));
  EXPECT_EQ(LevelsOfMu("{from: 1e-7, to: 3e-7, step: 1e-7}"), (Levels{"1e-07", "2e-07", "3e-07"}));
  EXPECT_EQ(LevelsOfMu("{from: -0.0, to: 0, step: 1}"), (Levels{"0"}));
  EXPECT_EQ(LevelsOfMu("[-0, 1]"), (Levels{"0", "1"}));
  // `to` is reached whatever the step, in tenths, hundredths and thousandths.
  for (const int parts : {10, 100, 1000}) {
    for (int n = 1; n <= 60; ++n) {
      const double step = static_cast<double>(n) / parts, to = static_cast<double>(17 * n) / parts;
      const Levels levels = LevelsOfMu(fmt::format("{{from: 0, to: {}, step: {}}}", to, step));
      ASSERT_EQ(levels.size(), 18u) << step;
      for (int i = 0; i <= 17; ++i) {
        EXPECT_EQ(levels[static_cast<size_t>(i)], fmt::format("{}", static_cast<double>(i * n) / parts));
      }
    }
  }
}

TEST(TuneBlock, LevelsOfAWholeNumberAndWords) {
  const Study study = ParseStudy(
      EditedTuning("mu: " + kSteps, "num_iterations: {from: 50, to: 200, step: 50}\n    mu: [auto, 1e0]"),
      "a.yaml");
  EXPECT_EQ(study.tuning->options[0].levels, (Levels{"50", "100", "150", "200"}));
  EXPECT_EQ(study.tuning->options[1].levels, (Levels{"auto", "1"}));
}

TEST(TuneBlock, IsNoPartOfTheIdentity) {
  const StudyPlan tuned = MakePlan(ParseStudy(TuningYaml(), "small.yaml")), plain = MakePlan(SmallStudy());
  EXPECT_EQ(tuned.identity, plain.identity);
  EXPECT_EQ(tuned.study_yaml, plain.study_yaml);
}

TEST(TuneBlock, SettingsInOrder) {
  const Tuning tuning = *ParseStudy(TuningYaml(), "small.yaml").tuning;
  ASSERT_EQ(NumSettings(tuning), 30u);
  EXPECT_EQ(LevelsOfSetting(tuning, 0), (Levels{"0", "0.5", "mean_entropy"}));
  EXPECT_EQ(LevelsOfSetting(tuning, 1), (Levels{"0", "0.5", "predictive_likelihood"}));
  EXPECT_EQ(LevelsOfSetting(tuning, 6), (Levels{"0.3", "0.5", "mean_entropy"}));
  EXPECT_EQ(LevelsOfSetting(tuning, 29), (Levels{"1.2", "1", "predictive_likelihood"}));
  const EstimatorSpec spec = WithLevels(tuning, LevelsOfSetting(tuning, 29), SmallStudy().estimators[1]);
  EXPECT_EQ(ReadOption(spec, "mu"), "1.2");
  EXPECT_EQ(ReadOption(spec, "lambda"), "1");
  EXPECT_EQ(ReadOption(spec, "selection"), "predictive_likelihood");
  EXPECT_EQ(ReadOption(spec, "num_iterations"), "20");
}

TEST(TuneBlockErrors, Keys) {
  EXPECT_TRUE(RefusesTuning(EditedTuning("at_most:", "atmost:"),
                            {":13:", "tune", "'atmost'", "known keys", "at_most", "options"}));
  EXPECT_TRUE(
      RefusesTuning(EditedTuning("explore: 20", "at_most: 0.2"), {":14:", "tune", "'at_most'", "twice"}));
  EXPECT_TRUE(RefusesTuning(EditedTuning("  estimator: ours\n", ""), {"tune: key 'estimator' is missing"}));
  EXPECT_TRUE(RefusesTuning(SmallStudyYaml() + "tune: {estimator: ours}\n",
                            {":10:", "tune: key 'options' is missing"}));
  EXPECT_TRUE(RefusesTuning(SmallStudyYaml() + "tune: {estimator: ours, options: {}}\n",
                            {":10:", "at least one option"}));
  EXPECT_TRUE(RefusesTuning(SmallStudyYaml() + "tune: {estimator: ours, options: [mu]}\n",
                            {":10:", "tune: options", "a map"}));
  EXPECT_TRUE(RefusesTuning(SmallStudyYaml() + "tune: fast\n", {":10:", "tune", "a map"}));
  EXPECT_TRUE(RefusesTuning(SmallStudyYaml() + "tune:\n", {":10:", "the value of 'tune' is missing"}));
  EXPECT_TRUE(RefusesTuning(EditedTuning("mu: " + kSteps, "mus: [1]"),
                            {":16:", "no option 'mus'", "its options", "lambda"}));
  EXPECT_TRUE(RefusesTuning(EditedTuning("lambda: [0.5, 0.8, 1.0]", "mu: [1]"), {":17:", "'mu'", "twice"}));
}

TEST(TuneBlockErrors, Values) {
  EXPECT_TRUE(RefusesTuning(EditedTuning("estimator: ours", "estimator: theirs"),
                            {":11:", "estimator", "'theirs'", "no label", "standard, ours"}));
  EXPECT_TRUE(RefusesTuning(EditedTuning("estimator: ours", "estimator: ''"), {":11:", "estimator", "''"}));
  EXPECT_TRUE(RefusesTuning(EditedTuning("false_refusal", "speed"),
                            {":12:", "'speed'", "false_refusal, failure, accepted_failure, risk"}));
  EXPECT_TRUE(RefusesTuning(EditedTuning("at_most: 0.1", "at_most: 0"),
                            {":13:", "at_most", "'0'", "a number in [1e-06, 0.999]"}));
  EXPECT_TRUE(RefusesTuning(EditedTuning("at_most: 0.1", "at_most: .nan"),
                            {":13:", "at_most", "'.nan'", "a number in"}));
  EXPECT_TRUE(RefusesTuning(EditedTuning("at_most: 0.1", "at_most: [0.1]"),
                            {":13:", "at_most", "one value is needed"}));
  EXPECT_TRUE(RefusesTuning(EditedTuning("explore: 20", "explore: 0"),
                            {":14:", "explore", "'0'", "a whole number in [1, "}));
}

TEST(TuneBlockErrors, Levels) {
  EXPECT_TRUE(RefusesLevels("[1, .nan]", {"mu", "'.nan'", "a number in [-1000, 1000] or auto"}));
  EXPECT_TRUE(RefusesLevels("[1, 1001]", {"mu", "'1001'", "a number in [-1000, 1000] or auto"}));
  EXPECT_TRUE(RefusesLevels("[1, [2]]", {"mu", "one value is needed"}));
  EXPECT_TRUE(RefusesLevels("[1, 2, 1]", {"mu", "level '1'", "twice"}));
  EXPECT_TRUE(RefusesLevels("[1, 1.0]", {"mu", "level '1.0'", "twice"}));
  EXPECT_TRUE(RefusesLevels("[]", {"mu", "at least one level"}));
  EXPECT_TRUE(RefusesLevels("5", {"mu", "a list of at least one level is needed, or {from: "}));
  EXPECT_TRUE(RefusesTuning(EditedTuning("[mean_entropy, ", "[least_entropy, "),
                            {":18:", "selection", "'least_entropy'", "mean_entropy, predictive_likelihood"}));
  EXPECT_TRUE(RefusesTuning(EditedTuning("mu: " + kSteps, "num_iterations: {from: 50, to: 60, step: 2.5}"),
                            {":16:", "num_iterations", "'52.5'", "whole number"}));
  EXPECT_TRUE(RefusesTuning(EditedTuning("mu: " + kSteps, "reading: {from: 0, to: 1, step: 1}"),
                            {":16:", "reading", "'0'", "as_printed, rank_aware"}));
}

TEST(TuneBlockErrors, Steps) {
  EXPECT_TRUE(RefusesLevels("{from: 3, to: 1, step: 1}", {"mu: from: '3'", "a number <= to, which is 1"}));
  EXPECT_TRUE(RefusesLevels("{from: 0, to: 1, step: 0}", {"mu: step: '0'", "a number > 0"}));
  EXPECT_TRUE(RefusesLevels("{from: 0, to: 1, step: -0.5}", {"mu: step: '-0.5'", "a number > 0"}));
  for (const char* step : {"1e-9", "1e-300", "5e-324"}) {
    EXPECT_TRUE(RefusesLevels(fmt::format("{{from: 0, to: 1, step: {}}}", step),
                              {"mu: step", step, "more than 20000 levels"}));
  }
  EXPECT_TRUE(RefusesLevels("{from: -1e308, to: 1e308, step: 1}", {"mu: step", "more than 20000 levels"}));
  EXPECT_TRUE(RefusesLevels("{from: 0, to: 1e308, step: 1e308}", {"mu", "'1e+308'", "a number in [-1000"}));
  for (const char* word : {".nan", "nan", ".inf", "1e999", "one", "''"}) {
    for (const char* key : {"from", "to", "step"}) {
      std::string steps = "{from: 0, to: 1, step: 1}";
      const size_t at = steps.find(key) + std::string(key).size() + 2;
      EXPECT_TRUE(RefusesLevels(steps.replace(at, 1, word), {key, "is not allowed; give a number"}));
    }
  }
  EXPECT_TRUE(RefusesLevels("{from: 0, to: 1}", {"mu", "from, to and step are needed"}));
  EXPECT_TRUE(RefusesLevels("{from: 0, to: 1, by: 1}", {"mu", "'by'", "from, step, to"}));
  EXPECT_TRUE(RefusesLevels("{from: 0, to: 1, step: [1]}", {"step", "one value is needed"}));
}

TEST(TuneBlockErrors, TooManyCombinations) {
  const std::string many = "{from: 0, to: 1, step: 0.005}";  // 201 levels, twice
  EXPECT_TRUE(RefusesTuning(EditedTuning("[0.5, 0.8, 1.0]", many + "\n    kappa: " + many),
                            {"tune: options", "more than 20000 combinations"}));
  EXPECT_TRUE(RefusesLevels("{from: 0, to: 1, step: 0.00005}", {"more than 20000 levels"}));  // 20,001
  const std::string most = "{from: 0, to: 0.99995, step: 0.00005}";                           // 20,000
  const Study study =
      ParseStudy(SmallStudyYaml() + "tune: {estimator: ours, options: {mu: " + most + "}}\n", "most.yaml");
  EXPECT_EQ(NumSettings(*study.tuning), kMaxTunedSettings);
  std::string options;
  for (const char* option : {"mu", "lambda", "kappa", "inlier_ratio", "significance_level"})
    options += fmt::format("{}: {{from: 0.1, to: 0.5, step: 0.00003}}, ", option);
  EXPECT_TRUE(RefusesTuning(SmallStudyYaml() + "tune: {estimator: ours, options: {" + options + "}}\n",
                            {":10:", "more than 20000 combinations"}));
}

TEST(TuneBlockErrors, OptionsThatContradictEachOtherInACombination) {
  EXPECT_TRUE(RefusesTuning(EditedTuning("lambda: [0.5, 0.8, 1.0]", "reading: [rank_aware, as_printed]"),
                            {":16:", "{mu: 0, reading: as_printed, selection: predictive_likelihood}",
                             "needs reading: rank_aware"}));
  // Against an option that is not tuned.
  EXPECT_TRUE(RefusesTuning(EditedTuning("reading: rank_aware", "reading: as_printed"),
                            {":16:", "selection: predictive_likelihood}", "needs reading: rank_aware"}));
}

// A run does not depend on the block: with `--set` it may contradict the estimators, and the study that the
// run stores can be read back.
TEST(TuneBlock, IsNoPartOfARun) {
  Study study = ParseStudy(TuningYaml(), "small.yaml");
  Override(&study, "reading", "as_printed");
  EXPECT_FALSE(ParseStudy(ToYaml(study), "stored.yaml").tuning.has_value());
}

}  // namespace
}  // namespace rcme
