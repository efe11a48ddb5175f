// What is written of a set of pairs: every number of a report that is made by hand, in its place.
#include "experiments/real/truth_free/validate_output.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <regex>

#include "experiments/core/table/render_table.h"
#include "experiments/real/truth_free/validate_words.h"

namespace rcme {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();
constexpr double kNoBound = std::numeric_limits<double>::infinity();

SharedMemberRate MakeCoverage(double rate, const Interval& interval) {
  SharedMemberRate coverage;
  coverage.rate = rate;
  coverage.interval = interval;
  return coverage;
}

// One that holds, one that fails by the data, one without data.
std::vector<TruthFreeTest> TestsByHand() {
  TruthFreeTest simulation, halves, closure;
  simulation.name = kSimulationTest;
  simulation.num_values = 24;
  simulation.coverage = MakeCoverage(0.96, {0.9, 0.99});
  simulation.twin_coverage = MakeCoverage(0.94, {0.8, 0.98});
  simulation.ratio = {1.1, {0.9, 1.2}};
  simulation.verdict = TruthFreeVerdict::kHolds;
  halves.name = "spatial_halves";
  halves.num_units = 8;
  halves.num_values = 16;
  halves.coverage = MakeCoverage(0.75, {0.5, 0.9});
  halves.twin_coverage = MakeCoverage(0.9375, {0.81, 0.99});
  halves.ratio = {2.1, {1.8, 2.5}};
  halves.in_simulation = {1.05, {0.85, 1.25}};
  halves.against_twins = {2.0, {1.5, 2.6}};
  halves.verdict = TruthFreeVerdict::kTooSmall;
  halves.cause = FaultCause::kData;
  halves.units_needed = kNotKnown;
  closure.name = "closure";
  closure.degrees_of_freedom = 3;
  closure.coverage = closure.twin_coverage = MakeCoverage(kNotKnown, {0.0, 1.0});
  closure.ratio = closure.in_simulation = closure.against_twins = {kNotKnown, {0.0, kNoBound}};
  return {simulation, halves, closure};
}

// A fault too large, one too small, one that holds; p = 0.001 of there being none.
CalibrationReport CalibrationByHand() {
  CalibrationReport report;
  report.num_pairs = 7;
  report.p_value = 0.001;
  report.dispersion = 1.5;
  report.verdict = TruthFreeVerdict::kTooLarge;
  FaultReport focal, x, y;
  focal.fault = CameraFault::kFocalLength;
  focal.joint = {0.0052, 0.0004, {0.0045, 0.006}, 6.5};
  focal.alone = {0.005, 0.0003, {0.0044, 0.0056}, 6.0};
  focal.twins = {kNotKnown, kNotKnown, {-kNoBound, kNoBound}, 0.0};
  focal.verdict = TruthFreeVerdict::kTooLarge;
  x.fault = CameraFault::kPrincipalPointX;
  x.joint = {-3.0, 0.5, {-4.0, -2.0}, 5.0};
  x.verdict = TruthFreeVerdict::kTooSmall;
  y.fault = CameraFault::kPrincipalPointY;
  y.joint = {0.1, 0.2, {-0.3, 0.5}, 5.0};
  y.verdict = TruthFreeVerdict::kHolds;
  report.faults = {focal, x, y};
  return report;
}

SetReport SetReportByHand() {
  SetReport report;
  report.name = "fountain, east";
  report.num_pairs = 10;
  report.num_answered = 8;
  report.num_loops = {{3, 2}, {4, 1}};
  report.tests = TestsByHand();
  report.covariances = {TruthFreeVerdict::kTooSmall, FaultCause::kData, {"spatial_halves", "closure"}};
  report.rotation_sd_deg = 0.25;
  report.direction_sd_deg = 1.5;
  report.assumed_sigma_px = 0.5;
  report.sigma_px = {0.6, {0.55, 0.7}};
  report.sigma_verdict = TruthFreeVerdict::kUndecided;
  // The difference is beyond 0.05, below, both, not known.
  report.correlations = {{0.0, 1.0, 120.0, 0.3, 0.1, {0.15, 0.25}},
                         {1.0, 4.0, 200.0, 0.03, 0.01, {-0.02, 0.04}},
                         {4.0, 16.0, 50.0, 0.2, 0.1, {0.0, 0.25}},
                         {16.0, 64.0, 3.0, 0.5, kNotKnown, {kNotKnown, kNotKnown}}};
  report.calibration = CalibrationByHand();
  report.sizes = {6, {0.4, 0.05, {0.3, 0.5}, 5.5}, TruthFreeVerdict::kTooSmall};
  report.advice = {"look at the lens"};
  return report;
}

// Runs of spaces and line ends as one: what is said, whatever the widths.
std::string TableOfSet(const SetReport& report) {
  return std::regex_replace(ValidationAsTable({report}), std::regex("\\s+"), " ");
}

nlohmann::json MakeJson(const SetReport& report) {
  return nlohmann::json::parse(MakeValidationResult({report}).json);
}

std::string RenderWords(const ComparedMedians& ratio, TruthFreeVerdict verdict, FaultCause cause) {
  TruthFreeTest test;
  test.ratio = ratio;
  test.verdict = verdict;
  test.cause = cause;
  test.num_units = 20;
  test.units_needed = 20.0;
  return DescribeVerdict(test);
}

// Too large by the inverse, whose ends change places.
TEST(DescribeVerdict, ByHand) {
  using enum TruthFreeVerdict;
  EXPECT_EQ(RenderWords({1.1, {0.9, 1.2}}, kHolds, FaultCause::kNone), "holds: 1.1 [0.9, 1.2]");
  EXPECT_EQ(RenderWords({1.1, {0.9, 1.2}}, kNoData, FaultCause::kNone), "no data");
  EXPECT_EQ(RenderWords({2.1, {1.8, 2.5}}, kTooSmall, FaultCause::kData),
            "too small by 2.1 [1.8, 2.5] in variance; the data: in simulation it is not");
  EXPECT_EQ(RenderWords({2.1, {1.8, 2.5}}, kTooSmall, FaultCause::kBoth),
            "too small by 2.1 [1.8, 2.5] in variance; in simulation too, and more so here");
  EXPECT_EQ(
      RenderWords({0.5, {0.4, 0.625}}, kTooLarge, FaultCause::kEstimator),
      "too large by 2 [1.6, 2.5] in variance; the estimator's own covariance is too large, in simulation "
      "too");
}

// Of 20 units: 20 would not decide it by their number, 21 would.
TEST(DescribeVerdict, SaysWhatWouldDecide) {
  const ComparedMedians wide = {1.3, {0.9, 1.9}};
  EXPECT_EQ(RenderWords(wide, TruthFreeVerdict::kUndecided, FaultCause::kNone),
            "undecided: 1.3 [0.9, 1.9]; within 1.25 of one it would be by the approximation");
  TruthFreeTest test;
  test.ratio = wide;
  test.verdict = TruthFreeVerdict::kUndecided;
  test.num_units = 20;
  test.units_needed = 21.0;
  EXPECT_EQ(DescribeVerdict(test), "undecided: 1.3 [0.9, 1.9]; some 21 in place of 20 would decide it");
  test.units_needed = kNotKnown;
  EXPECT_EQ(DescribeVerdict(test), "undecided: 1.3 [0.9, 1.9]");
}

// An interval from nothing to infinity is said in words, with how many it takes.
TEST(DescribeVerdict, SaysThatFewPairsHaveNoInterval) {
  TruthFreeTest test;
  test.ratio = {75.0, {0.0, std::numeric_limits<double>::infinity()}};
  test.verdict = TruthFreeVerdict::kTooSmall;
  test.cause = FaultCause::kData;
  test.num_units = 3;
  EXPECT_EQ(
      DescribeVerdict(test),
      "too small by the coverage; the variances' ratio, 75 here, cannot be told from 3 pairs or loops: it "
      "takes 5 at least; the data: in simulation it is not");
  test.verdict = TruthFreeVerdict::kUndecided;
  test.units_needed = kNotKnown;
  EXPECT_EQ(
      DescribeVerdict(test),
      "undecided: the variances' ratio, 75 here, cannot be told from 3 pairs or loops: it takes 5 at least");
  SetReport report = SetReportByHand();
  report.tests[1] = test;
  report.tests[1].name = "spatial_halves";
  report.tests[1].against_twins = test.ratio;
  const std::string table = TableOfSet(report);
  EXPECT_EQ(table.find("inf"), std::string::npos) << table;
  EXPECT_NE(table.find("75: too few for an interval"), std::string::npos) << table;
}

TEST(MakeValidationTable, HasARowOfEveryTest) {
  const std::string set = "\"fountain, east\",10,8,";
  EXPECT_EQ(RenderCsv(MakeValidationTable({SetReportByHand()})),
            "set,pairs,answered,test,value,lower,upper,n,coverage,twin_coverage,verdict,cause\n" +  //
                set + "covariances,,,,8,,,too small,data\n" +                                       //
                set + "rotation_sd_deg,0.25,,,8,,,,\n" +                                            //
                set + "direction_sd_deg,1.5,,,8,,,,\n" +                                            //
                set + "simulation,1.1,0.9,1.2,24,0.96,0.94,holds,\n" +                              //
                set + "spatial_halves,2.1,1.8,2.5,16,0.75,0.9375,too small,data\n" +                //
                set + "closure,,0,,0,,,no data,\n" +                                                //
                set + "correlation_0_to_1_px,0.2,0.15,0.25,120,,,correlated,\n" +                   //
                set + "correlation_1_to_4_px,0.02,-0.02,0.04,200,,,holds,\n" +                      //
                set + "correlation_4_to_16_px,0.1,0,0.25,50,,,undecided,\n" +                       //
                set + "correlation_16_to_64_px,,,,3,,,no data,\n" +                                 //
                set + "calibration,0.001,,,7,,,wrong,\n" +                                          //
                set + "focal_length,0.0052,0.0045,0.006,7,,,wrong,\n" +                             //
                set + "principal_point_x,-3,-4,-2,7,,,wrong,\n" +                                   //
                set + "principal_point_y,0.1,-0.3,0.5,7,,,holds,\n" +                               //
                set + "noise_by_size,0.4,0.3,0.5,6,,,too small,\n" +                                //
                set + "sigma_px,0.6,0.55,0.7,8,,,undecided,\n");
}

TEST(MakeValidationTable, NamesTheCause) {
  SetReport report = SetReportByHand();
  report.tests[0].cause = FaultCause::kEstimator;
  report.tests[1].cause = FaultCause::kBoth;
  const std::string text = RenderCsv(MakeValidationTable({report}));
  EXPECT_THAT(text, HasSubstr(",0.96,0.94,holds,estimator\n"));
  EXPECT_THAT(text, HasSubstr(",0.75,0.9375,too small,both\n"));
}

TEST(ValidationAsTable, BeginsWithTheSet) {
  SetReport report = SetReportByHand();
  EXPECT_THAT(TableOfSet(report),
              testing::StartsWith(
                  "fountain, east: 10 pairs, 8 answered, 3 loops of images (2 of 3, 1 of 4) "
                  "covariances: too small; the data: in simulation it is not (spatial_halves, closure) "
                  "stated sd (median): 0.25 deg of rotation, 1.5 deg of direction"));
  EXPECT_THAT(TableOfSet(report), HasSubstr(" -> look at the lens"));
  report.num_loops.clear();
  report.covariances = {};
  report.rotation_sd_deg = report.direction_sd_deg = kNotKnown;
  EXPECT_THAT(TableOfSet(report),
              testing::StartsWith("fountain, east: 10 pairs, 8 answered, 0 loops of images "
                                  "covariances: no data"));
}

// The simulation has no twins of its own; a correlation that is not known has no row.
TEST(ValidationAsTable, HasARowOfEveryTest) {
  const std::string text = TableOfSet(SetReportByHand());
  EXPECT_THAT(text, HasSubstr(" simulation holds: 1.1 [0.9, 1.2] 24 "));
  EXPECT_THAT(text, HasSubstr(" simulation 96 % [90, 99] spatial_halves "));
  EXPECT_THAT(text, HasSubstr(" spatial_halves too small by 2.1 [1.8, 2.5] in variance; 16 the data: in "
                              "simulation it is not "));
  EXPECT_THAT(text, HasSubstr(" spatial_halves 75 % [50, 90] 2 [1.5, 2.6] 94 % [81, 99] "));
  EXPECT_THAT(text, HasSubstr(" closure no data 0 "));
  EXPECT_THAT(text, HasSubstr(" closure - - "));
  EXPECT_THAT(text, HasSubstr(" residuals 0 to 1 px apart correlated: correlation 0.2 [0.15, 0.25] 120"));
  EXPECT_THAT(text, HasSubstr(" residuals 1 to 4 px apart holds: correlation 0.02 [-0.02, 0.04] 200"));
  EXPECT_THAT(text, HasSubstr(" residuals 4 to 16 px apart undecided: correlation 0.1 [0, 0.25] 50"));
  EXPECT_THAT(text, Not(HasSubstr("residuals 16")));
  EXPECT_THAT(text, HasSubstr(" calibration some fault (p = 0.001) 7"));
  EXPECT_THAT(text, HasSubstr(" focal length 0.52 % [0.45, 0.6] too long 7"));
  EXPECT_THAT(text, HasSubstr(" principal point, y holds (within +-0.5 px) 7"));
  EXPECT_THAT(text, HasSubstr(" noise by size grows by 0.4 [0.3, 0.5] of what is 6 stated "));
  EXPECT_THAT(text, HasSubstr(" noise sigma 0.6 [0.55, 0.7] px, assumed 0.5: 8 undecided "));
}

TEST(ValidationAsTable, SaysWhatIsNominal) {
  const std::string text = TableOfSet(SetReportByHand());
  EXPECT_THAT(text, HasSubstr("within [1/1.5, 1.5],"));
  EXPECT_THAT(text, HasSubstr("nominal below 0.05."));
  EXPECT_THAT(text,
              HasSubstr("Nominal: focal length 0.2 %, principal point, x 1 px, principal point, y 1 px, "
                        "distortion k1 0.001, readout time 1 %, key points of image 2, x 0.1 px, key points "
                        "of image 2, y 0.1 px."));
  EXPECT_THAT(text, HasSubstr("nominal within 0.25 of one."));
}

TEST(MakeValidationResult, HasTheNumbersOfTheSet) {
  const auto whole =
      nlohmann::ordered_json::parse(MakeValidationResult({SetReportByHand(), SetReport()}).json);
  EXPECT_EQ(whole.begin().key(), "format");
  EXPECT_EQ(whole["format"], "rcme validation 3");
  EXPECT_EQ(whole["nominal_variance"], 1.5);
  EXPECT_EQ(whole["nominal_correlation"], 0.05);
  EXPECT_EQ(whole["sets"].size(), 2u);
  const nlohmann::json json = MakeJson(SetReportByHand());
  EXPECT_EQ(json.at("rows").size(), 16u);
  EXPECT_EQ(json.at("sets").at(0),
            nlohmann::json::parse(R"({"set": "fountain, east", "pairs": 10, "answered": 8,
      "covariances": "too small", "cause": "data", "by_tests": "spatial_halves closure",
      "rotation_sd_deg": 0.25, "direction_sd_deg": 1.5,
      "assumed_sigma_px": 0.5, "sigma_px": 0.6, "sigma_px_interval": [0.55, 0.7], "sigma_verdict": "undecided",
      "calibration_pairs": 7, "calibration_p_value": 0.001, "calibration_dispersion": 1.5,
      "calibration_verdict": "wrong", "size_pairs": 6, "size_slope": 0.4, "size_slope_interval": [0.3, 0.5],
      "size_slope_effective_pairs": 5.5, "size_verdict": "too small"})"));
  EXPECT_EQ(json.at("loops"), nlohmann::json::parse(R"([{"set": "fountain, east", "images": 3, "loops": 2},
      {"set": "fountain, east", "images": 4, "loops": 1}])"));
  EXPECT_EQ(json.at("advice"),
            nlohmann::json::parse(R"([{"set": "fountain, east", "advice": "look at the lens"}])"));
}

// What is not known is null, an end that is not bounded too.
TEST(MakeValidationResult, HasTheNumbersOfEveryTest) {
  const nlohmann::json tests = MakeJson(SetReportByHand()).at("tests");
  ASSERT_EQ(tests.size(), 3u);
  EXPECT_EQ(tests.at(1), nlohmann::json::parse(R"({"set": "fountain, east", "test": "spatial_halves",
      "degrees_of_freedom": 5, "n": 16, "coverage": 0.75, "coverage_interval": [0.5, 0.9],
      "twin_coverage": 0.9375, "twin_coverage_interval": [0.81, 0.99], "ratio": 2.1,
      "ratio_interval": [1.8, 2.5], "in_simulation": 1.05, "in_simulation_interval": [0.85, 1.25],
      "against_twins": 2.0, "against_twins_interval": [1.5, 2.6], "verdict": "too small", "cause": "data",
      "units": 8, "units_needed": null})"));
  EXPECT_EQ(tests.at(2), nlohmann::json::parse(R"({"set": "fountain, east", "test": "closure",
      "degrees_of_freedom": 3, "n": 0, "coverage": null, "coverage_interval": [0.0, 1.0],
      "twin_coverage": null, "twin_coverage_interval": [0.0, 1.0], "ratio": null,
      "ratio_interval": [0.0, null], "in_simulation": null, "in_simulation_interval": [0.0, null],
      "against_twins": null, "against_twins_interval": [0.0, null], "verdict": "no data", "cause": "",
      "units": 0, "units_needed": 0.0})"));
}

TEST(MakeValidationResult, HasTheNumbersOfCorrelationsAndFaults) {
  const nlohmann::json json = MakeJson(SetReportByHand());
  ASSERT_EQ(json.at("correlations").size(), 4u);
  EXPECT_EQ(json.at("correlations").at(1), nlohmann::json::parse(R"({"set": "fountain, east", "from_px": 1.0,
      "to_px": 4.0, "n": 200.0, "correlation": 0.03, "twin_correlation": 0.01,
      "difference_interval": [-0.02, 0.04], "verdict": "holds"})"));
  EXPECT_EQ(json.at("correlations").at(3), nlohmann::json::parse(R"({"set": "fountain, east", "from_px": 16.0,
      "to_px": 64.0, "n": 3.0, "correlation": 0.5, "twin_correlation": null,
      "difference_interval": [null, null], "verdict": "no data"})"));
  ASSERT_EQ(json.at("camera_faults").size(), 3u);
  EXPECT_EQ(json.at("camera_faults").at(0), nlohmann::json::parse(R"({"set": "fountain, east",
      "fault": "focal_length", "nominal": 0.002, "beside_others": 0.0052,
      "beside_others_interval": [0.0045, 0.006], "beside_others_effective_pairs": 6.5, "alone": 0.005,
      "alone_interval": [0.0044, 0.0056], "alone_effective_pairs": 6.0, "twins": null,
      "twins_interval": [null, null], "twins_effective_pairs": 0.0, "verdict": "wrong",
      "in_words": "0.52 % [0.45, 0.6] too long"})"));
}

}  // namespace
}  // namespace rcme
