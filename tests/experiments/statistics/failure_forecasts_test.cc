#include "experiments/statistics/failure_forecasts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <vector>

#include "experiments/statistics/forecast_measures.h"
#include "experiments/statistics/forecast_output.h"
#include "parameters/input_error.h"
#include "stats/constants.h"
#include "stats/random.h"
#include "tests/test_support/add_records.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/small_study.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

// A motion of estimator 0 ("standard") with its probability (NaN: none) and share of inliers of 100 matches.
TrialRecord StatedMotion(std::uint32_t trial, double probability, int num_inliers, bool failed) {
  TrialRecord record;
  record.trial = trial;
  record.status = MotionStatus::kOk;
  record.rotation_error_deg = failed ? 90.0 : 0.1;
  record.direction_error_deg = 1.0;
  record.num_matches = 100;
  record.num_inliers = num_inliers;
  record.failure_probability = probability;
  return record;
}

TrialRecord Refusal(std::uint32_t trial) {
  TrialRecord record = StatedMotion(trial, 0.9, 3, false);
  record.status = MotionStatus::kTooUncertain;
  return record;
}

class FailureForecastsTest : public testing::Test {
 protected:
  FailureForecastsTest() {
    study_.estimators.resize(1);
    study_.trials = 4000;
  }
  ResultStore Stored(const std::vector<TrialRecord>& records) {
    const std::string path = folder_.Path("run_" + std::to_string(num_files_++));
    {
      ResultStore store = ResultStore::OpenForRun(path, MakePlan(study_));
      AddRecords(store, records);
    }
    return ResultStore::OpenForReading(path);
  }
  FailureForecasts Collected(const std::vector<TrialRecord>& records) {
    return CollectFailureForecasts(Stored(records)).at(0);
  }

  TempFolder folder_;
  int num_files_ = 0;
  Study study_ = SmallStudy();
};

TEST_F(FailureForecastsTest, WeightedTrialsAreRefused) {
  {
    ResultStore store = ResultStore::OpenForRun(folder_.Path("weighted"), MakePlan(study_));
    ProblemRecord problem;
    problem.weight = 0.5;
    store.Add({problem}, {StatedMotion(0, 0.25, 50, true)});
  }
  const ResultStore weighted = ResultStore::OpenForReading(folder_.Path("weighted"));
  EXPECT_TRUE(ThrowsInputError([&] { CollectFailureForecasts(weighted); }, {"weighted"}));
}

TEST_F(FailureForecastsTest, StatedOnesAreOfScoredAnswers) {
  std::vector<TrialRecord> records = {StatedMotion(0, 0.25, 50, true), StatedMotion(1, 0.0, 50, false),
                                      Refusal(2), StatedMotion(3, kNaN, 50, true),
                                      StatedMotion(4, 0.5, 50, false)};
  records[4].rotation_error_deg = kNaN;  // its truth is not known
  records.push_back(StatedMotion(5, 0.125, 50, false));
  records.back().status = MotionStatus::kInvalidCovariance;
  const FailureForecasts stated = Collected(records);
  EXPECT_EQ(stated.estimator, "standard");
  EXPECT_EQ(stated.source, ForecastSource::kStated);
  ASSERT_EQ(stated.forecasts.size(), 3U);
  EXPECT_EQ(stated.forecasts[0].probability, 0.25);
  EXPECT_TRUE(stated.forecasts[0].happened);
  EXPECT_FALSE(stated.forecasts[1].happened);
  EXPECT_EQ(stated.forecasts[2].probability, 0.125);
  EXPECT_TRUE(stated.forecasts[2].happened) << "an answer that is not valid has failed";
  EXPECT_EQ(stated.refused_clusters.size(), 1U);
  EXPECT_EQ(stated.num_without, 1);
  const FailureBounds bounds = study_.failure;
  EXPECT_EQ(BrierOfStated(records[0], bounds), 0.5625);
  for (const size_t i : {2U, 3U, 4U}) EXPECT_FALSE(BrierOfStated(records[i], bounds)) << i;
}

// Probabilities fitted to the other half of the run are not judged by a p; stated ones are.
TEST_F(FailureForecastsTest, FittedProbabilitiesHaveNoPValue) {
  std::vector<TrialRecord> stated, fitted;
  for (std::uint32_t trial = 0; trial < 40; ++trial) {
    stated.push_back(StatedMotion(trial, 0.25, 50, trial % 4 == 0));
    fitted.push_back(StatedMotion(trial, kNaN, 50, trial % 4 == 0));
  }
  const ForecastMeasures of_stated = MeasureFailureForecasts(Stored(stated)).at(0),
                         of_fitted = MeasureFailureForecasts(Stored(fitted)).at(0);
  EXPECT_EQ(of_fitted.source, ForecastSource::kInlierShare);
  EXPECT_GT(of_fitted.n, 0);
  EXPECT_TRUE(of_stated.check.p_value > 0.0 && of_stated.error_of_equal_width.p_value > 0.0);
  EXPECT_TRUE(std::isnan(of_fitted.check.p_value) && std::isnan(of_fitted.error_of_equal_width.p_value));
  EXPECT_TRUE(std::isnan(of_fitted.error_of_equal_mass.p_value));
}

// A pure rotation: whether the direction is within its bound has no answer, even where the rotation is off.
TEST_F(FailureForecastsTest, AProbabilityOfAMotionWithoutDirectionIsNotJudged) {
  std::vector<TrialRecord> records = {StatedMotion(0, 0.9, 50, false), StatedMotion(1, 0.9, 50, true)};
  for (TrialRecord& record : records) record.direction_error_deg = kNaN;
  const FailureForecasts none = Collected(records);
  EXPECT_EQ(none.source, ForecastSource::kStated);
  EXPECT_TRUE(none.forecasts.empty());
  EXPECT_EQ(none.num_without, 2);
  EXPECT_FALSE(BrierOfStated(records[0], study_.failure));
  records.push_back(StatedMotion(2, 0.25, 50, false));
  EXPECT_EQ(Collected(records).forecasts.size(), 1U);
  EXPECT_THAT(ForecastsAsTable(MeasureFailureForecasts(Stored(records))), testing::HasSubstr("not judged"));
}

TEST_F(FailureForecastsTest, AScenesTrialsAreOneCluster) {
  study_.repeats_per_scene = 2;
  std::vector<TrialRecord> records;
  for (std::uint32_t trial = 0; trial < 4; ++trial) records.push_back(StatedMotion(trial, 0.1, 50, false));
  records.push_back(StatedMotion(0, 0.1, 50, false));
  records.back().condition = 1;
  const std::vector<Forecast> forecasts = Collected(records).forecasts;
  EXPECT_EQ(forecasts[0].cluster, forecasts[1].cluster);
  EXPECT_EQ(forecasts[2].cluster, forecasts[3].cluster);
  EXPECT_NE(forecasts[0].cluster, forecasts[2].cluster);
  EXPECT_NE(forecasts[0].cluster, forecasts[4].cluster) << "of another condition";
}

TEST_F(FailureForecastsTest, ConditionsThatShareTheirScenesShareClusters) {
  study_.common_scenes = true;
  std::vector<TrialRecord> records = {StatedMotion(0, 0.1, 50, false), StatedMotion(1, 0.1, 50, false),
                                      StatedMotion(0, 0.1, 50, false)};
  records[2].condition = 1;
  const std::vector<Forecast> forecasts = Collected(records).forecasts;
  EXPECT_EQ(forecasts[0].cluster, forecasts[2].cluster);
  EXPECT_NE(forecasts[0].cluster, forecasts[1].cluster);
}

// Even trials with 80 inliers fail once in four, with 20 always; odd ones never with 80 and in half with 20.
// The probability of each half is the rate of the other.
TEST_F(FailureForecastsTest, SharesOfInliersAreRecalibratedOnTheOtherHalf) {
  std::vector<TrialRecord> records;
  for (std::uint32_t trial = 0; trial < 16; ++trial) {
    const std::uint32_t k = trial / 2;  // 0..7 within its half
    const bool is_even = trial % 2 == 0, is_good = k < 4;
    const bool failed = is_even ? (is_good ? k == 0 : true) : (is_good ? false : k < 6);
    records.push_back(StatedMotion(trial, kNaN, is_good ? 80 : 20, failed));
  }
  records.push_back(Refusal(16));
  records.back().failure_probability = kNaN;
  const FailureForecasts proxy = Collected(records);
  EXPECT_EQ(proxy.source, ForecastSource::kInlierShare);
  ASSERT_EQ(proxy.forecasts.size(), 16U);
  for (std::uint32_t trial = 0; trial < 16; ++trial) {
    const bool is_even = trial % 2 == 0, is_good = trial / 2 < 4;
    EXPECT_EQ(proxy.forecasts[trial].probability, is_even ? (is_good ? 0.0 : 0.5) : (is_good ? 0.25 : 1.0))
        << trial;
  }
  EXPECT_EQ(Collected({StatedMotion(0, kNaN, 80, false)}).num_without, 1) << "no other half to learn from";
}

TEST_F(FailureForecastsTest, GroupsAreTheLevelsOfAFactor) {
  std::vector<TrialRecord> records = {StatedMotion(0, 0.1, 50, false), StatedMotion(0, 0.2, 50, false),
                                      StatedMotion(1, 0.3, 50, true)};
  records[1].condition = records[2].condition = 1;
  const ResultStore store = Stored(records);
  const std::vector<FailureForecasts> groups = CollectFailureForecasts(store, "outlier_ratio");
  ASSERT_EQ(groups.size(), 2U);
  EXPECT_EQ(groups[0].group, "0");
  EXPECT_EQ(groups[0].forecasts.size(), 1U);
  EXPECT_EQ(groups[1].group, "0.3");
  EXPECT_EQ(groups[1].forecasts.size(), 2U);
  EXPECT_THROW(CollectFailureForecasts(store, "no_factor"), InputError);
}

// Made-up trials of known quality: right probabilities, uniform on [0, c], c = .4. The rate is c / 2, Brier
// c / 2 - c^2 / 3; failures have the density 2 p / c^2, the others F(p) = (p - p^2 / 2) / (c - c^2 / 2), so
// that the area under the curve is (2 c / 3 - c^2 / 4) / (c - c^2 / 2).
TEST_F(FailureForecastsTest, MeasuresOfRightProbabilities) {
  RandomStream rng({.seed = 1, .purpose = 450});
  std::vector<TrialRecord> records;
  for (std::uint32_t trial = 0; trial < 3000; ++trial) {
    const double p = 0.4 * rng.Uniform();
    records.push_back(StatedMotion(trial, p, 50, rng.Uniform() < p));
  }
  for (std::uint32_t trial = 3000; trial < 3300; ++trial) records.push_back(Refusal(trial));
  const ForecastMeasures m = MeasureForecasts(Collected(records), 7);
  EXPECT_EQ(m.n, 3000);
  EXPECT_EQ(m.num_refused, 300);
  EXPECT_NEAR(m.mean_probability, 0.2, 0.01);
  EXPECT_TRUE(m.failure.interval.Contains(0.2));
  EXPECT_TRUE(m.brier.interval.Contains(0.2 - 0.16 / 3.0));
  EXPECT_TRUE(m.line.slope.interval.Contains(1.0));
  EXPECT_LT(m.line.slope.standard_error, 0.15);
  EXPECT_GT(m.check.p_value, 0.001);
  EXPECT_GT(m.error_of_equal_width.p_value, 0.001);
  EXPECT_GT(m.error_of_equal_mass.p_value, 0.001);
  EXPECT_TRUE(m.area.interval.Contains((0.8 / 3.0 - 0.04) / 0.32));
  EXPECT_LT(m.area.standard_error, 0.02);
  EXPECT_NEAR(static_cast<double>(m.num_sure), 750.0, 4.0 * std::sqrt(750.0 * 0.75));
  EXPECT_TRUE(m.sure_failed_interval.Contains(0.05));
  EXPECT_NEAR(m.risk_coverage.back().coverage, 1.0, 1e-12);
  EXPECT_NEAR(m.risk_coverage.back().risk, (m.failure.value * 3000.0 + 300.0) / 3300.0, 1e-12)
      << "refusals are failures";
  EXPECT_EQ(m.bins.size(), 4U);
  ASSERT_EQ(m.histogram.size(), 20U);
  EXPECT_EQ(std::accumulate(m.histogram.begin(), m.histogram.end(), std::int64_t{0}), 3000);
  EXPECT_NEAR(static_cast<double>(m.histogram[6]), 3000.0 * (0.1225 - 0.09) / 0.4, 80.0);
  EXPECT_EQ(m.histogram[13], 0) << "from .4225 on";
}

// 20 draws of a population with 5 scenes each, whose probabilities are right; ten equal trials of a scene say
// no more about them than one.
TEST(FailureForecasts, RepeatsOfAScenesOfAPopulationDoNotMakeProbabilitiesWrong) {
  RandomStream rng({.seed = 1, .purpose = 451});
  FailureForecasts once{"a", "", ForecastSource::kStated, true, {}, {}, 0}, repeated = once;
  for (std::int64_t scene = 0; scene < 100; ++scene) {
    const double p = rng.Uniform();
    const Forecast forecast{p, rng.Uniform() < p, scene / 5};
    once.forecasts.push_back(forecast);
    once.scenes.push_back(scene);
    repeated.forecasts.insert(repeated.forecasts.end(), 10, forecast);
    repeated.scenes.insert(repeated.scenes.end(), 10, scene);
  }
  const ForecastMeasures of_once = MeasureForecasts(once, 7), of_repeated = MeasureForecasts(repeated, 7);
  EXPECT_EQ(of_repeated.check.p_value, of_once.check.p_value);
  EXPECT_NEAR(of_repeated.error_of_equal_width.p_value, of_once.error_of_equal_width.p_value, 1e-9);
}

TEST(AddForecastsOfRun, KeepsTheScenesOfTwoRunsApart) {
  const FailureForecasts first{"a", "", ForecastSource::kStated, false, {{0.1, false, 0}, {0.2, true, 3}},
                               {5}, 1};
  const FailureForecasts second{"a", "", ForecastSource::kStated, false, {{0.3, true, 0}}, {2}, 2};
  const FailureForecasts other{"b", "", ForecastSource::kStated, false, {{0.4, false, 0}}, {}, 0};
  std::vector<FailureForecasts> all;
  AddForecastsOfRun({first}, &all);
  AddForecastsOfRun({second, other}, &all);
  ASSERT_EQ(all.size(), 2U);
  ASSERT_EQ(all[0].forecasts.size(), 3U);
  EXPECT_EQ(all[0].forecasts[2].cluster, 6);
  EXPECT_EQ(all[0].refused_clusters, (std::vector<std::int64_t>{5, 8}));
  EXPECT_EQ(all[0].num_without, 3);
  EXPECT_EQ(all[1].forecasts[0].cluster, 6);
}

TEST(AddForecastsOfRun, RefusesProbabilitiesOfTwoKinds) {
  std::vector<FailureForecasts> all = {{"a", "", ForecastSource::kStated, false, {}, {}, 0}};
  try {
    AddForecastsOfRun({{"a", "", ForecastSource::kInlierShare, false, {}, {}, 0}}, &all);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "a: its probabilities of failure are stated in one run and inlier_share in another");
  }
}

TEST_F(FailureForecastsTest, TableAndFileSayTheSame) {
  const ResultStore store = Stored({StatedMotion(0, 0.05, 50, false), StatedMotion(1, 0.75, 50, true),
                                    StatedMotion(2, 0.05, 50, true), Refusal(3)});
  const std::vector<ForecastMeasures> measures = MeasureFailureForecasts(store);
  const std::string table = ForecastsAsTable(measures);
  EXPECT_THAT(table, testing::HasSubstr("standard"));
  EXPECT_THAT(table, testing::HasSubstr("stated"));
  EXPECT_THAT(table, testing::Not(testing::HasSubstr("stands in"))) << "no proxy, no word of it";
  EXPECT_THAT(table, testing::HasSubstr("50.00 % [1.26, 98.74]"));
  EXPECT_THAT(table, testing::Not(testing::HasSubstr("not judged"))) << "no column without such answers";
  const auto json = nlohmann::json::parse(MakeForecastResult("small", "", measures).json);
  EXPECT_EQ(json["format"], "rcme reliability 1");
  const auto& entry = json["entries"].at(0);
  EXPECT_EQ(entry["source"], "stated");
  EXPECT_EQ(entry["n"], 3);
  EXPECT_EQ(entry["refused"], 1);
  EXPECT_EQ(entry["sure_failed"]["n"], 2);
  EXPECT_NEAR(entry["brier"]["value"].get<double>(), (0.0025 + 0.0625 + 0.9025) / 3.0, 1e-12);
  EXPECT_NEAR(entry["brier"]["value"].get<double>(),
              entry["miscalibration"].get<double>() - entry["discrimination"].get<double>() +
                  entry["uncertainty"].get<double>(),
              1e-12);
  EXPECT_EQ(entry["risk_coverage"].back()["probability"], nullptr) << "the refusal";
  EXPECT_EQ(entry["risk_coverage"].back()["coverage"], 1.0);
}

// All ten trials of 4 of 40 scenes fail at a small P: by scenes about [0.03, 0.24], by trials [0.07, 0.13].
TEST_F(FailureForecastsTest, RatesOfRepeatedScenesAreByScene) {
  std::vector<TrialRecord> records;
  for (std::uint32_t trial = 0; trial < 400; ++trial)
    records.push_back(StatedMotion(trial, 0.01, 50, trial < 40));
  const Interval by_trials = MeasureForecasts(Collected(records), 7).sure_failed_interval;
  EXPECT_EQ(by_trials.lower, ExactBinomialInterval(40, 400).lower);
  EXPECT_EQ(by_trials.upper, ExactBinomialInterval(40, 400).upper);
  study_.repeats_per_scene = 10;
  const ForecastMeasures by_scenes = MeasureForecasts(Collected(records), 7);
  EXPECT_EQ(by_scenes.num_sure_failed, 40);
  EXPECT_LT(by_scenes.sure_failed_interval.lower, 0.05);
  EXPECT_GT(by_scenes.sure_failed_interval.upper, 0.18);
  EXPECT_LT(by_scenes.sure_interval.lower, 0.95) << "40 scenes, all of them sure";
}

TEST_F(FailureForecastsTest, WithoutAnswersOnlyCountsAreGiven) {
  const std::vector<ForecastMeasures> measures = MeasureFailureForecasts(Stored({Refusal(0), Refusal(1)}));
  EXPECT_EQ(measures[0].n, 0);
  EXPECT_THAT(ForecastsAsTable(measures), testing::HasSubstr("standard"));
  const auto json = nlohmann::json::parse(MakeForecastResult("small", "", measures).json);
  EXPECT_EQ(json["entries"][0]["refused"], 2);
  EXPECT_FALSE(json["entries"][0].contains("brier"));
}

}  // namespace
}  // namespace rcme
