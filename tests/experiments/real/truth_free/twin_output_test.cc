// What is written of twins: every number of a report that is made by hand, in its place.
#include "experiments/real/truth_free/twin_output.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <regex>

#include "experiments/core/table/render_table.h"

namespace rcme {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

TwinFit FitByHand() {
  TwinFit fit;
  fit.num_templates = 11;
  fit.noise.noise_px = 0.31234;
  fit.noise.student_dof = 2.5;
  fit.noise.near_share = 0.25;
  fit.noise.far_share = 0.1;
  fit.noise.far_length_px = 80.0;
  fit.simulated_noise.noise_px = 0.298;
  fit.num_matches = 210;
  fit.wrong_share = 0.2;
  fit.wrong_agreeing_share = 0.35;
  fit.rotation_deg = 1.5;
  fit.parallax_deg = 4.2;
  fit.forwardness = 0.12;
  fit.nearest = 3.14;
  fit.farthest = 27.2;
  fit.homography_share = 0.4;
  fit.clark_evans = 0.87;
  return fit;
}

// A rate and a mean of an unbounded interval, predicted, and a mean of either twin, fitted: the first and the
// last are missed.
TwinReport TwinReportByHand() {
  TwinReport report;
  report.scene = "fountain, east";
  report.num_pairs = 12;
  report.fit = FitByHand();
  report.semi_real = {{"scene", "match_files"}, {"folder", "pairs"}};
  report.simulated = {{"scene", "image_clusters"}, {"num_matches", "210"}};
  report.comparisons = {
      {"refusal", "semi_real", true, false, 12, 0.25, 0.5, {0.1, 0.4}},
      {"sigma_px", "semi_real", false, true, 9, 0.5, 0.45, {0.4, 0.6}},
      {"stated_failure", "semi_real", false, false, 3, 0.125, 0.25, {-kUnbounded, kUnbounded}},
      {"sigma_px", "simulated", false, true, 9, 0.5, 0.75, {0.3, 0.7}}};
  return report;
}

// Runs of spaces and line ends as one: what is said, whatever the widths.
std::string TextOfTwins(const TwinReport& report) {
  return std::regex_replace(MakeTwinsResult({report}).text, std::regex("\\s+"), " ");
}

TEST(MakeTwinsResult, HasARowOfEveryComparison) {
  EXPECT_EQ(RenderCsv(MakeTwinsResult({TwinReportByHand()}).rows),
            "scene,pairs,twin,quantity,kind,fitted,observed,lower,upper,n,predicted,within\n"
            "\"fountain, east\",12,semi_real,refusal,rate,no,0.25,0.1,0.4,12,0.5,no\n"
            "\"fountain, east\",12,semi_real,sigma_px,mean,yes,0.5,0.4,0.6,9,0.45,yes\n"
            "\"fountain, east\",12,semi_real,stated_failure,mean,no,0.125,,,3,0.25,yes\n"
            "\"fountain, east\",12,simulated,sigma_px,mean,yes,0.5,0.3,0.7,9,0.75,no\n");
}

TEST(TwinsResult, SaysWhatWasFitted) {
  EXPECT_THAT(TextOfTwins(TwinReportByHand()),
              testing::StartsWith(
                  "fountain, east: 12 pairs, 11 with a geometry to resemble"
                  " noise 0.312 px, Student's t of 2.5, 25 % common within 1 px, 10 % within 80 px"
                  " simulated with 0.298 px and normal"
                  " 210 matches, 20 % wrong (35 % of those move as a neighbour)"
                  " rotation 1.5 deg, parallax 4.2 deg, |t_z| 0.12, depths 3.1 to 27 baselines, one plane "
                  "explains 40 %, Clark-Evans 0.87 "));
}

// Shares below half of a per cent are none.
TEST(TwinsResult, LeavesOutNoiseThatIsNotShared) {
  TwinReport report = TwinReportByHand();
  report.fit.noise = {};
  report.fit.noise.noise_px = 0.5;
  report.fit.noise.near_share = report.fit.noise.far_share = 0.0049;
  EXPECT_THAT(TextOfTwins(report), HasSubstr(" noise 0.5 px, normal "));
}

TEST(TwinsResult, HasARowOfEveryQuantity) {
  const std::string text = TextOfTwins(TwinReportByHand());
  EXPECT_THAT(text, HasSubstr(" refusal 12 0.5 0.25 [0.1, 0.4] no no "));
  EXPECT_THAT(text, HasSubstr(" stated_failure 3 0.25 0.125 no yes "));
  EXPECT_THAT(text, HasSubstr(" semi-real observed"));
  EXPECT_THAT(text, HasSubstr(" sigma_px 9 0.45 0.5 [0.4, 0.6] yes yes "));
  EXPECT_THAT(text, HasSubstr(" simulated observed"));
  EXPECT_THAT(text, HasSubstr(" sigma_px 9 0.75 0.5 [0.3, 0.7] yes no "));
  EXPECT_THAT(text,
              HasSubstr(" within: semi-real 1 of 2 predicted, 1 of 1 fitted; simulated 0 of 0 predicted, "
                        "0 of 1 fitted "));
  EXPECT_THAT(text, Not(ContainsRegex(" failure [0-9]")));                 // is not compared
  EXPECT_THAT(text, HasSubstr(" failure motion beyond 3 deg or 15 deg"));  // is explained all the same
}

// Means of a semi-real twin are paired with those of the pairs: it may have fewer than the simulated one.
TEST(TwinsResult, SaysTheNumberOfPairsOfEachTwin) {
  TwinReport report = TwinReportByHand();
  report.comparisons[1].n = 8;
  EXPECT_THAT(TextOfTwins(report), HasSubstr(" sigma_px 8 0.45 "));
  EXPECT_THAT(TextOfTwins(report), HasSubstr(" sigma_px 9 0.75 "));
}

// Of the semi-real twin alone; whether it was fitted says what it means.
TEST(TwinsResult, SaysWhatSimulationLacks) {
  TwinReport report = TwinReportByHand();
  EXPECT_THAT(TextOfTwins(report), HasSubstr(" not explained: no motion, of all pairs: scenes near what the "
                                             "estimator refuses: planes, little parallax "));
  EXPECT_THAT(TextOfTwins(report), Not(HasSubstr("not met by the fit")));
  report.comparisons[0].predicted = 0.4;
  report.comparisons[1].predicted = 0.39;
  EXPECT_THAT(TextOfTwins(report), Not(HasSubstr("not explained")));
  EXPECT_THAT(TextOfTwins(report), HasSubstr(" not met by the fit: noise estimated from the residuals (px), "
                                             "mean: noise that differs from pair to pair "));
}

TEST(TwinsResult, SaysWhyNothingIsSimulated) {
  TwinReport report = TwinReportByHand();
  report.simulated.clear();
  report.why_not_simulated = "the views overlap too little";
  report.comparisons.pop_back();
  const std::string text = TextOfTwins(report);
  EXPECT_THAT(text, HasSubstr("1 of 1 fitted; no simulated scene: the views overlap too little "));
  EXPECT_THAT(text, Not(HasSubstr("simulated with")));
  EXPECT_THAT(text, Not(HasSubstr("simulated observed")));
}

TEST(TwinsResult, HasEveryNumber) {
  const auto json = nlohmann::ordered_json::parse(MakeTwinsResult({TwinReportByHand()}).json);
  EXPECT_EQ(json.begin().key(), "format");
  EXPECT_EQ(json["format"], "rcme twin 1");
  ASSERT_EQ(json["scenes"].size(), 1u);
  const auto scene = nlohmann::json::parse(json["scenes"][0].dump());
  ASSERT_EQ(scene.at("comparisons").size(), 4u);
  EXPECT_EQ(scene.at("comparisons").at(0),
            nlohmann::json::parse(R"({"twin": "semi_real", "quantity": "refusal",
      "kind": "rate", "fitted": false, "n": 12, "observed": 0.25, "interval": [0.1, 0.4], "predicted": 0.5,
      "within": false})"));
  EXPECT_EQ(scene.at("comparisons").at(2), nlohmann::json::parse(R"({"twin": "semi_real",
      "quantity": "stated_failure", "kind": "mean", "fitted": false, "n": 3, "observed": 0.125,
      "interval": [null, null], "predicted": 0.25, "within": true})"));
  EXPECT_EQ(scene.at("comparisons").at(3),
            nlohmann::json::parse(R"({"twin": "simulated", "quantity": "sigma_px",
      "kind": "mean", "fitted": true, "n": 9, "observed": 0.5, "interval": [0.3, 0.7], "predicted": 0.75,
      "within": false})"));
  nlohmann::json rest = scene;
  rest.erase("comparisons");
  EXPECT_EQ(rest, nlohmann::json::parse(R"({"name": "fountain, east", "pairs": 12, "templates": 11,
      "semi_real": {"scene": "match_files", "folder": "pairs"},
      "simulated": {"scene": "image_clusters", "num_matches": "210"}, "why_not_simulated": ""})"));
}

}  // namespace
}  // namespace rcme
