// The question, the study that it becomes, and what is read from a run of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "experiments/ask/accept_rule.h"
#include "experiments/ask/answer_output.h"
#include "experiments/ask/question.h"
#include "experiments/study/study_file.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

AskedTexts Corridor() { return {"1280x720", "900", "0.7", "corridor", "0.4"}; }

TEST(Ask, AsksForWhatIsMissingAlone) {
  AskedTexts texts = Corridor();
  texts.focal_px = texts.scene = "";
  EXPECT_EQ(MissingOptions(texts), (std::vector<std::string>{"--focal", "--scene"}));
  std::istringstream in("\n  900 \ncorridor\n");
  std::ostringstream out;
  AskForMissing(in, out, &texts);
  EXPECT_EQ(texts.focal_px, "900") << "an empty line is asked again, blanks around are left out";
  EXPECT_EQ(texts.scene, "corridor");
  EXPECT_EQ(out.str().find("Size of an image"), std::string::npos);
  EXPECT_TRUE(MissingOptions(texts).empty());
  texts.wrong = "";
  std::istringstream nothing;
  EXPECT_THROW(AskForMissing(nothing, out, &texts), InputError);
}

TEST(Ask, ReadsTheTextsAndRefusesWhatIsNone) {
  Question question;
  ReadTexts(Corridor(), &question);
  EXPECT_EQ(question.image_width, 1280);
  EXPECT_EQ(question.image_height, 720);
  EXPECT_EQ(question.focal_px, 900.0);
  EXPECT_EQ(question.sigma_px, 0.7);
  EXPECT_EQ(question.outlier_ratio, 0.4);
  const std::vector<std::pair<std::string AskedTexts::*, std::string>> wrong = {
      {&AskedTexts::image, "1280"},  {&AskedTexts::image, "1280x"},  {&AskedTexts::image, "1280x720x3"},
      {&AskedTexts::image, "8x8"},   {&AskedTexts::focal_px, "0"},   {&AskedTexts::focal_px, "900px"},
      {&AskedTexts::sigma_px, "-1"}, {&AskedTexts::sigma_px, "nan"}, {&AskedTexts::scene, "corridoor"},
      {&AskedTexts::wrong, "40"},    {&AskedTexts::wrong, "1"}};
  for (const auto& [text, value] : wrong) {
    AskedTexts texts = Corridor();
    texts.*text = value;
    EXPECT_THROW(ReadTexts(texts, &question), InputError) << value;
  }
}

TEST(Ask, TheStudyIsTheQuestion) {
  Question question;
  ReadTexts(Corridor(), &question);
  question.motion = "forward";
  question.outliers = "clustered_both";
  // Peers and estimator files are the program's (end_to_end/ask_test.cc).
  const std::string text = MakeStudyText(question);
  const Study study = ParseStudy(
      text.substr(0, text.find("estimators:")) + "estimators: [{name: rcme_calibrated}]\n", "asked.yaml");
  EXPECT_EQ(study.name, "asked");
  EXPECT_EQ(study.factors.size(), 1u);
  for (const auto& [key, value] : Settings{{"scene", "corridor"},
                                           {"cameras", "pinhole"},
                                           {"motion", "forward"},
                                           {"image_width", "1280"},
                                           {"focal_px", "900"},
                                           {"sigma_px", "0.7"},
                                           {"outliers", "clustered_both"}}) {
    const bool is_there = std::ranges::count(study.data, Settings::value_type(key, value)) == 1;
    EXPECT_TRUE(is_there) << key;
  }
}

TEST(Ask, CoverageIsNotSaidWithoutSharpness) {
  Answer answer;
  answer.best.label = "ours";
  answer.coverage = {.value = 0.94, .interval = {0.9, 0.97}};
  const auto says = [&](const std::string& words) {  // in however many lines
    std::istringstream text(AnswerAsText(answer, "?", "folder"));
    std::string all, word;
    while (text >> word) all += word + " ";
    return all.find(words) != std::string::npos;
  };
  EXPECT_FALSE(says("stated sd"));
  answer.rotation_sd_deg = 0.25, answer.direction_sd_deg = 1.5;
  EXPECT_TRUE(says("; stated sd 0.25 deg of rotation, 1.5 deg of direction"));
  answer.sd_over_crb = 1.625;
  EXPECT_TRUE(says("; stated sd 1.62 times the least possible"));
  EXPECT_EQ(nlohmann::json::parse(AnswerAsJson(answer, "?"))["sd_over_crb"], 1.625);
}

// 300 answers of P 0.004, none of which fails, and 100 of P 0.15, of which half do. P(Binomial(300, 0.05) =
// 0) = 2.1e-7 certifies the first; of all 400, 50 fail.
TEST(Ask, TheAcceptRuleIsTheLoosestThatIsCertified) {
  std::vector<StatedAnswer> answers(300, {0.004, false});
  for (int i = 0; i < 100; ++i) answers.push_back({0.15, i % 2 == 0});
  const std::optional<AcceptRule> rule = CertifyAcceptRule(answers, 500, 0.05, 1);
  ASSERT_TRUE(rule);
  EXPECT_EQ(rule->greatest_probability, 0.1) << "the greatest of the list below the failures";
  EXPECT_EQ(rule->accepted.n, 300);
  EXPECT_EQ(rule->accepted.errors, 0);
  EXPECT_EQ(rule->num_trials, 500);
  EXPECT_EQ(CertifyAcceptRule(answers, 500, 0.2, 1)->greatest_probability, 1.0) << "50 of 400: 12.5 %";
}

TEST(Ask, TooFewAnswersCertifyNothing) {
  EXPECT_FALSE(CertifyAcceptRule({}, 100, 0.05, 1));
  // (1 - 0.05)^n <= 0.05 / 9 needs 102 answers, 0.05 / 45 needs 133.
  for (const auto& [num_estimators, fewest] : {std::pair(1, 102), std::pair(5, 133)}) {
    EXPECT_EQ(FewestCertifyingAnswers(0.05, num_estimators), fewest);
    const auto n = static_cast<size_t>(fewest);
    EXPECT_FALSE(
        CertifyAcceptRule(std::vector<StatedAnswer>(n - 1, {0.01, false}), fewest - 1, 0.05, num_estimators));
    EXPECT_TRUE(CertifyAcceptRule(std::vector<StatedAnswer>(n, {0.01, false}), fewest, 0.05, num_estimators));
  }
}

// How often a rule of the best of `num_estimators` is certified that accepts more failures than it may: all
// of them fail in `at_most` of 400 trials, whatever they state.
int CountWrongRules(int num_runs, double at_most, int num_estimators, int num_stated) {
  RandomStream rng({1, 0, 0, 78});
  const auto count_failures = [](const std::vector<StatedAnswer>& answers) {
    return std::ranges::count(answers, true, &StatedAnswer::has_failed);
  };
  int num_wrong = 0;
  for (int run = 0; run < num_runs; ++run) {
    std::vector<StatedAnswer> best;
    for (int estimator = 0; estimator < num_estimators; ++estimator) {
      std::vector<StatedAnswer> answers;
      for (int i = 0; i < 400; ++i) answers.push_back({rng.Uniform(), rng.Uniform() < at_most});
      if (best.empty() || count_failures(answers) < count_failures(best)) best = answers;
    }
    num_wrong += CertifyAcceptRule(best, 400, at_most, num_stated).has_value();
  }
  return num_wrong;
}

// The promise of 0.05 holds for the estimator that the same trials chose; false alarms of this test:
// P(Binomial (1000, 0.05) > 70) = 0.002. Without the choice in the level it is broken, so the test has power.
TEST(Ask, AWrongRuleOfTheChosenEstimatorIsCertifiedRarely) {
  for (const int num_estimators : {5, 20}) {
    const int num_wrong = CountWrongRules(1000, 0.1, num_estimators, num_estimators);
    EXPECT_LE(num_wrong, 70) << num_estimators;
    EXPECT_GE(num_wrong, 1) << "not so cautious that it never is";
  }
  EXPECT_GT(CountWrongRules(1000, 0.1, 20, 1), 70);
}

}  // namespace
}  // namespace rcme
