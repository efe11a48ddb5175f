// The question, the study that it becomes, and what is read from a run of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "experiments/ask/answer.h"
#include "experiments/ask/answer_output.h"
#include "experiments/ask/question.h"
#include "experiments/study/study_file.h"
#include "parameters/input_error.h"
#include "tests/test_support/add_records.h"
#include "tests/test_support/small_study.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

AskedTexts Corridor() { return {"1280x720", "900", "0.7", "corridor", "0.4"}; }

TEST(Ask, AsksForWhatIsMissingAlone) {
  AskedTexts texts = Corridor();
  texts.focal_px = texts.scene = "";
  EXPECT_EQ(MissingOptions(texts), (std::vector<std::string>{"--focal", "--scene"}));
  std::istringstream in("\n900px\n  900 \ncorridoor\ncorridor\n");
  std::ostringstream out;
  AskForMissing(in, out, &texts);
  EXPECT_EQ(texts.focal_px, "900") << "an empty line is asked again, blanks around are left out";
  EXPECT_EQ(texts.scene, "corridor");
  for (const std::string refused : {"'900px' is not allowed", "'corridoor' is not a scene"})
    EXPECT_NE(out.str().find(refused), std::string::npos) << "asked again at once\n" << out.str();
  EXPECT_EQ(out.str().find("Size of an image"), std::string::npos);
  EXPECT_TRUE(MissingOptions(texts).empty());
  texts.wrong = "";
  std::istringstream nothing;
  EXPECT_THROW(AskForMissing(nothing, out, &texts), InputError);
}

// An empty line takes the default; with all that is needed nothing is asked.
TEST(Ask, AsksForMotionAndOutliersAfterTheOthers) {
  AskedTexts texts = Corridor();
  std::ostringstream out;
  std::istringstream unread("forward\n");
  AskForMissing(unread, out, &texts);
  EXPECT_EQ(out.str(), "");
  texts.wrong = "";
  std::istringstream in("40%\n\nclustered\nclustered_both\n");
  AskForMissing(in, out, &texts);
  EXPECT_EQ(texts.motion, "");
  EXPECT_EQ(texts.outliers, "clustered_both");
  EXPECT_NE(out.str().find("'clustered' is not a kind of wrong matches"), std::string::npos) << out.str();
  Question question;
  ReadTexts(texts, &question);
  EXPECT_EQ(question.motion, "");
  EXPECT_EQ(question.outliers, "clustered_both");
}

TEST(Ask, TheNextCommandsAreQuotedForAShell) {
  Answer answer;
  answer.best.label = "ours";
  const std::string text = AnswerAsText(answer, "?", "my dir");
  for (const char* part : {"rcme report 'my dir/run.sqlite' --out 'my dir/report.html'",
                           "rcme solve 'my dir/study.yaml' --estimators ours", "--out 'my dir/solve'"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " is missing in\n" << text;
}

TEST(Ask, ReadsTheTextsAndRefusesWhatIsNone) {
  Question question;
  ReadTexts(Corridor(), &question);
  EXPECT_EQ(question.image_width, 1280);
  EXPECT_EQ(question.image_height, 720);
  EXPECT_EQ(question.focal_px, 900.0);
  EXPECT_EQ(question.sigma_px, 0.7);
  EXPECT_EQ(question.outlier_ratio, 0.4);
  for (const std::string image : {"1280 720", "1280 x 720", "1280X720"}) {
    AskedTexts texts = Corridor();
    Question same;
    texts.image = image;
    ReadTexts(texts, &same);
    EXPECT_EQ(std::pair(same.image_width, same.image_height), std::pair(1280, 720)) << image;
  }
  for (const std::string wrong : {"40%", "40 %", "0.40"}) {
    AskedTexts texts = Corridor();
    Question same;
    texts.wrong = wrong;
    ReadTexts(texts, &same);
    EXPECT_EQ(MakeStudyText(same, 9), MakeStudyText(question, 9)) << wrong;
  }
  const std::vector<std::pair<std::string AskedTexts::*, std::string>> wrong = {
      {&AskedTexts::image, "1280"},  {&AskedTexts::image, "1280x"},  {&AskedTexts::image, "1280x720x3"},
      {&AskedTexts::image, "8x8"},   {&AskedTexts::focal_px, "0"},   {&AskedTexts::focal_px, "900px"},
      {&AskedTexts::sigma_px, "-1"}, {&AskedTexts::sigma_px, "nan"}, {&AskedTexts::scene, "corridoor"},
      {&AskedTexts::wrong, "40"},    {&AskedTexts::wrong, "1"},      {&AskedTexts::wrong, "100%"},
      {&AskedTexts::wrong, "%"},     {&AskedTexts::wrong, "nan%"},   {&AskedTexts::image, "1280 720 3"},
      {&AskedTexts::image, "x"},     {&AskedTexts::image, "1e3x99"}, {&AskedTexts::focal_px, "1e300"}};
  for (const auto& [text, value] : wrong) {
    AskedTexts texts = Corridor();
    texts.*text = value;
    EXPECT_THROW(ReadTexts(texts, &question), InputError) << value;
  }
}

TEST(Ask, OnlyALatticeHasRepeatedTexture) {
  Question question;
  question.scene = "room";
  CheckOutliers(question);
  question.outliers = "repeated_texture";
  EXPECT_THROW(CheckOutliers(question), InputError);
  question.scene = "lattice";
  CheckOutliers(question);
}

TEST(Ask, TheStudyIsTheQuestion) {
  Question question;
  ReadTexts(Corridor(), &question);
  question.motion = "forward";
  question.outliers = "clustered_both";
  // Peers and estimator files are the program's (end_to_end/ask_test.cc).
  const std::string text = MakeStudyText(question, 120);
  const Study study = ParseStudy(
      text.substr(0, text.find("estimators:")) + "estimators: [{name: rcme_calibrated}]\n", "asked.yaml");
  EXPECT_EQ(study.name, "asked");
  EXPECT_EQ(study.trials, 120);
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

// The words of an answer's text, in however many lines.
std::string JoinWords(const Answer& answer) {
  std::istringstream text(AnswerAsText(answer, "?", "folder"));
  std::string all, word;
  while (text >> word) all += word + " ";
  return all;
}

TEST(Ask, CoverageIsNotSaidWithoutSharpness) {
  Answer answer;
  answer.best.label = "ours";
  answer.coverage = {.value = 0.94, .interval = {0.9, 0.97}};
  const auto says = [&](const std::string& words) {
    return JoinWords(answer).find(words) != std::string::npos;
  };
  EXPECT_FALSE(says("stated sd"));
  answer.sharpness.rotation_sd_deg = 0.25, answer.sharpness.direction_sd_deg = 1.5;
  EXPECT_TRUE(says("; stated sd 0.25 deg of rotation, 1.5 deg of direction"));
  answer.sharpness.sd_over_crb = 1.625;
  EXPECT_TRUE(says("; stated sd 1.62 times the least possible"));
  EXPECT_EQ(nlohmann::json::parse(AnswerAsJson(answer, "?"))["sd_over_crb"], 1.625);
}

// Errors differ by more than chance if they differ by more than 0.01 deg.
TEST(Ask, ThoseOfEqualSuccessAreRankedByErrorThenTimeThenP) {
  const auto ranked = [](std::vector<AskedEstimator> estimators) {
    RankEstimators(&estimators, [](const AskedEstimator& a, const AskedEstimator& b) {
      return a.median_error_deg > b.median_error_deg + 0.01;
    });
    std::string labels;
    for (const AskedEstimator& estimator : estimators) labels += estimator.label;
    return labels;
  };
  const auto make = [](const char* label, double success, double error_deg, double time_ms,
                       bool states_p = false) {
    return AskedEstimator{label, {.value = success}, time_ms, error_deg, states_p, ""};
  };
  EXPECT_EQ(ranked({make("a", 0.9, 0.1, 1.0), make("b", 1.0, 0.9, 9.0)}), "ba") << "success first";
  EXPECT_EQ(ranked({make("a", 1.0, 0.2, 1.0), make("b", 1.0, 0.1, 9.0)}), "ba") << "then the error";
  EXPECT_EQ(ranked({make("a", 1.0, 0.114, 15.0), make("b", 1.0, 0.116, 1.0)}), "ba")
      << "0.11 and 0.12 in two digits, but alike";
  EXPECT_EQ(ranked({make("a", 1.0, 0.1, 1.0), make("b", 1.0, 0.1, 1.05, true)}), "ba") << "as fast, with P";
  EXPECT_EQ(ranked({make("a", 1.0, 0.1, 1.0), make("b", 1.0, 0.1, 2.0, true)}), "ab") << "time before P";
  // b is alike to both, c has greater errors than a.
  EXPECT_EQ(ranked({make("a", 1.0, 0.100, 9.0), make("b", 1.0, 0.108, 5.0), make("c", 1.0, 0.116, 1.0)}),
            "bac");
  EXPECT_EQ(ranked({make("a", 1.0, kNaN, 10.0), make("b", 1.0, 0.1, 9.0), make("c", kNaN, 0.0, 0.0)}), "bac")
      << "what is not known is last";
}

TEST(Ask, AnInlierThresholdHasItsUnit) {
  // The square root of the 95 % quantile of chi-squared with one degree of freedom is 1.95996.
  EXPECT_EQ(DescribeInlierThreshold("msac", {{"significance_level", "0.05"}}, 0.7),
            "1.37 px of Sampson distance (1.96 sigma: keeps 95 % of the true matches)");
  EXPECT_EQ(DescribeInlierThreshold("opencv_usac", {{"threshold_sigma", "1.5"}}, 0.5),
            "1.5 px as OpenCV takes it (1.5 standard deviations of its distance)");
  EXPECT_EQ(DescribeInlierThreshold("opengv_ransac", {{"threshold_sigma", "2"}}, 0.7),
            "1.4 px of reprojection error in both images together (2 sigma)");
  const std::string rcme = DescribeInlierThreshold("rcme", {{"significance_level", "0.05"}}, 0.7);
  EXPECT_TRUE(rcme.starts_with("none in px: a test that keeps 95 % of the true matches")) << rcme;
  const std::string calibrated = DescribeInlierThreshold("rcme_calibrated", {{"sigma", "estimated"}}, 0.7);
  EXPECT_TRUE(calibrated.starts_with("none: ")) << calibrated;
  EXPECT_TRUE(calibrated.ends_with("(estimated, from 0.7 px on)")) << calibrated;
  EXPECT_EQ(DescribeInlierThreshold("own", {}, 0.7), "");
}

// Three estimators: standard, which states probabilities, ours, third.
class AnswerOfRun : public testing::Test {
 protected:
  struct Outcome {
    double error_deg, failure_probability = kNaN;
    MotionStatus status = MotionStatus::kOk;
  };
  // Adds trials of which each has these outcomes.
  void Add(int num_trials, const std::vector<Outcome>& outcomes) {
    for (int i = 0; i < num_trials; ++i, ++num_trials_) {
      for (const Outcome& outcome : outcomes) {
        TrialRecord record;
        record.trial = num_trials_;
        record.estimator = static_cast<std::uint32_t>(&outcome - outcomes.data());
        record.status = outcome.status;
        record.rotation_error_deg = outcome.error_deg;
        record.direction_error_deg = HasDirection(question_) ? 0.01 : kNaN;
        record.failure_probability = outcome.failure_probability;
        records_.push_back(record);
      }
    }
  }
  Answer Ask() {
    std::string yaml = SmallStudyYaml() + "  - {name: standard, label: third}\n";
    yaml.replace(yaml.find("[0.0, 0.3]"), 10, "[0.3]");
    Study study = ParseStudy(yaml, "asked.yaml");
    study.trials = static_cast<int>(num_trials_);
    for (TrialRecord& record : records_) record.seconds = 1e-3 * times_ms_[record.estimator];
    AddRecords(*std::make_unique<ResultStore>(ResultStore::OpenForRun(path_, MakePlan(study))), records_);
    return AnswerQuestion(ResultStore::OpenForReading(path_), question_, 0.05);
  }

  TempFolder folder_;
  std::string path_ = folder_.Path("run.sqlite");
  Question question_;
  std::array<double, 3> times_ms_ = {1.0, 1.0, 1.0};
  std::uint32_t num_trials_ = 0;
  std::vector<TrialRecord> records_;
};

// standard and ours succeed in 200 of 200, third fails in 50.
TEST_F(AnswerOfRun, TwoOfThreeAreTied) {
  Add(150, {{1.0, 0.01}, {0.5}, {0.1}});
  Add(50, {{1.0, 0.01}, {0.5}, {90.0}});
  const Answer answer = Ask();
  EXPECT_EQ(answer.best.label, "ours") << "its median error is the least of the two";
  ASSERT_EQ(answer.alike.size(), 1u);
  EXPECT_EQ(answer.alike[0].label, "standard");
  // Of Clopper-Pearson with the confidence 1 - 0.05 / 3: (0.025 / 3)^(1 / 200).
  EXPECT_NEAR(answer.best.success.interval.lower, std::pow(0.025 / 3.0, 1.0 / 200.0), 1e-9);
  EXPECT_EQ(answer.difference->difference.value, 0.0);
  // (1.959964 sqrt(0.01) + 0.841621 sqrt(0.01 - 0.0001))^2 / 0.0001 = 782.5
  EXPECT_EQ(answer.difference->trials_of_plain_difference, 783);
  EXPECT_EQ(answer.stating, "standard") << "ours states nothing, and cannot be told from it";
  ASSERT_TRUE(answer.rule);
  EXPECT_EQ(answer.rule->accepted.n, 200);
  const std::string words = JoinWords(answer);
  for (const std::string part :
       {"2 of 3 succeed in 200 of 200; ours leads: the errors of standard are greater by 0.5 deg ",
        "standard answers, whatever its P: 100.0 % of the trials, 0 of 200 failed",
        "standard states 1.00 % on average, 0.00 % [0.00, 2.37] (n 200) fail: right to within 5 % ",
        "200; to tell a 1 % difference in success takes about 780; to show a failure rate below 0.1 % about "
        "4800 without",
        "Success: an error of at most 3 deg of rotation and 15 deg of direction.",
        "Accepted answers fail in less than 5 %", "--estimators ours", "--out folder/solve --max-time 5m"})
    EXPECT_NE(words.find(part), std::string::npos) << part << "\n" << words;
  const auto json = nlohmann::json::parse(AnswerAsJson(answer, "?"));
  EXPECT_EQ(json["alike"][0]["label"], "standard");
  EXPECT_EQ(json["stating"]["accept"]["accepted"], 200);
  EXPECT_FALSE(json.contains("accept")) << "the best states no probability";
}

// Every second error of standard is the smaller one: its median is less, but that is chance.
TEST_F(AnswerOfRun, ALesserMedianErrorMayBeChance) {
  Add(50, {{0.10}, {0.13}, {90.0}});
  Add(49, {{0.12}, {0.11}, {90.0}});
  times_ms_ = {15.0, 1.0, 1.0};
  const Answer answer = Ask();
  EXPECT_EQ(answer.best.label, "ours") << "the fastest of those whose errors are alike";
  const std::string words = JoinWords(answer);
  for (const std::string part :
       {"ours leads: it is faster, the errors of standard are alike", "ours states no P",
        "Covariance the 95 % region of ours", "Time ours: 1 ms a call"})
    EXPECT_NE(words.find(part), std::string::npos) << part << "\n" << words;
}

// standard gives a direction that is not there, ours refuses it and is as right; third has a wrong rotation.
TEST_F(AnswerOfRun, WithoutADirectionTheRotationIsTheAnswer) {
  question_.motion = "pure_rotation";
  constexpr MotionStatus kRefused = MotionStatus::kDirectionNotObservable;
  Add(60, {{0.1, 0.2}, {0.1, 0.0, kRefused}, {9.0, kNaN, kRefused}});
  const Answer answer = Ask();
  EXPECT_EQ(answer.best.success.value, 1.0);
  ASSERT_EQ(answer.alike.size(), 1u) << "refusing the direction is right, a rotation off by 9 deg is not";
  EXPECT_EQ(answer.alike[0].success.value, 1.0);
  EXPECT_EQ(answer.stating, "");
  const std::string words = JoinWords(answer);
  EXPECT_EQ(words.find("Trust in P"), std::string::npos) << words;
  EXPECT_EQ(words.find("15 deg"), std::string::npos) << words;
  EXPECT_NE(words.find("an answer that refuses to give one succeeds by its rotation"), std::string::npos)
      << words;
  const Answer of_direction = AnswerQuestion(ResultStore::OpenForReading(path_), Question(), 0.05);
  EXPECT_EQ(of_direction.alike.size(), 0u) << "where there is a direction, refusing it is no success";
}

// ours fails in one trial of 40: one discordant trial says nothing.
TEST_F(AnswerOfRun, OneFailureMoreMayBeChance) {
  Add(39, {{1.0, 0.2}, {0.5}, {90.0}});
  Add(1, {{1.0, 0.2}, {90.0}, {90.0}});
  const Answer answer = Ask();
  EXPECT_EQ(answer.best.label, "standard") << "by success, although its error is greater";
  ASSERT_EQ(answer.alike.size(), 1u);
  EXPECT_EQ(answer.alike[0].label, "ours");
  EXPECT_EQ(answer.stating, "standard");
  // (1.959964 sqrt(0.025) + 0.841621 sqrt(0.025 - 0.000625))^2 / 0.000625 = 311.0
  EXPECT_EQ(answer.difference->trials_to_tell, 312);
  const std::string words = JoinWords(answer);
  for (const std::string part :
       {"40 of 40; not told apart from it: ours 39 ", "2.50 % [", "less, may be chance",
        "no bound on the P of standard keeps failures below 5 % yet: that takes at least 123 answers without "
        "a failure",
        "standard states 20.00 % on average, 0.00 % [0.00, 11.28] (n 40) fail: too pessimistic ",
        "40; about 310 tell the first two apart"})
    EXPECT_NE(words.find(part), std::string::npos) << part << "\n" << words;
}

TEST_F(AnswerOfRun, WhereNoneSucceedsTheOrderSaysNothing) {
  Add(40, {{90.0, 0.9}, {80.0}, {70.0}});
  const std::string words = JoinWords(Ask());
  EXPECT_NE(words.find("none of the 3 succeeds in any of 40 trials: the order says nothing"),
            std::string::npos)
      << words;
  EXPECT_EQ(words.find("leads"), std::string::npos) << words;
}

// third succeeds in 30 of 40 trials, the others in none.
TEST_F(AnswerOfRun, ALeadThatIsMoreThanChanceHasNoTies) {
  Add(30, {{90.0, 0.9}, {90.0}, {0.1}});
  Add(10, {{90.0, 0.9}, {90.0}, {90.0}});
  const Answer answer = Ask();
  EXPECT_EQ(answer.best.label, "third");
  EXPECT_TRUE(answer.alike.empty());
  EXPECT_EQ(answer.stating, "") << "that which states a probability fails more often";
  const std::string words = JoinWords(answer);
  EXPECT_EQ(words.find("Ties"), std::string::npos);
  EXPECT_NE(words.find("third states no P: nothing to accept by"), std::string::npos) << words;
  EXPECT_NE(words.find("less, more than chance"), std::string::npos) << words;
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
