// The question, the study that it becomes, and what is read from a run of it.
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "experiments/ask/answer.h"
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

// 300 answers of P 0.004, none of which fails, and 100 of P 0.15, of which half do. P(Binomial(300, 0.05) =
// 0) = 2.1e-7 certifies the first; of all 400, 50 fail.
TEST(Ask, TheAcceptRuleIsTheLoosestThatIsCertified) {
  std::vector<StatedAnswer> answers(300, {0.004, false});
  for (int i = 0; i < 100; ++i) answers.push_back({0.15, i % 2 == 0});
  const std::optional<AcceptRule> rule = CertifyAcceptRule(answers, 500, 0.05);
  ASSERT_TRUE(rule);
  EXPECT_EQ(rule->greatest_probability, 0.1) << "the greatest of the list below the failures";
  EXPECT_EQ(rule->accepted.n, 300);
  EXPECT_EQ(rule->accepted.errors, 0);
  EXPECT_EQ(rule->num_trials, 500);
  EXPECT_EQ(CertifyAcceptRule(answers, 500, 0.2)->greatest_probability, 1.0) << "50 of 400: 12.5 %";
}

TEST(Ask, TooFewAnswersCertifyNothing) {
  EXPECT_FALSE(CertifyAcceptRule({}, 100, 0.05));
  // (1 - 0.05)^n <= 0.05 / 9 needs 102 answers.
  EXPECT_FALSE(CertifyAcceptRule(std::vector<StatedAnswer>(101, {0.01, false}), 101, 0.05));
  EXPECT_TRUE(CertifyAcceptRule(std::vector<StatedAnswer>(102, {0.01, false}), 102, 0.05));
}

// Where right answers and failures do not depend on P, a rule of a rate beyond the target is certified in at
// most a share of 0.05 of the runs, for the whole list.
TEST(Ask, AWrongRuleIsCertifiedRarely) {
  RandomStream rng({1, 0, 0, 78});
  int num_wrong = 0;
  for (int run = 0; run < 1000; ++run) {
    std::vector<StatedAnswer> answers;
    for (int i = 0; i < 400; ++i) answers.push_back({rng.Uniform(), rng.Uniform() < 0.1});
    num_wrong += CertifyAcceptRule(answers, 400, 0.1).has_value();
  }
  EXPECT_LE(num_wrong, 50 + 20);
  EXPECT_GE(num_wrong, 1) << "not so cautious that it never is";
}

}  // namespace
}  // namespace rcme
