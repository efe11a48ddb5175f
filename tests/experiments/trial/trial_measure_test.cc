#include "experiments/trial/trial_measure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "stats/constants.h"
#include "stats/random.h"

namespace rcme {
namespace {

TrialRecord Record(MotionStatus status, double rotation_deg, double direction_deg) {
  TrialRecord record;
  record.status = status;
  record.rotation_error_deg = rotation_deg;
  record.direction_error_deg = direction_deg;
  return record;
}
TrialRecord MakeAnsweredRecord(double rotation_deg, double direction_deg) {
  return Record(MotionStatus::kOk, rotation_deg, direction_deg);
}

TrialMeasure Find(const std::string& name) {
  for (const auto* measures : {&TrialScores(), &TrialErrors()}) {
    const auto found = std::ranges::find(*measures, name, &TrialMeasure::name);
    if (found != measures->end()) return *found;
  }
  ADD_FAILURE() << "no measure called " << name;
  return {};
}

double ComputeMeanMeasure(const std::string& name, const std::vector<double>& errors_deg) {
  double sum = 0.0;
  for (const double error : errors_deg) sum += Find(name).Of(MakeAnsweredRecord(error, 0.0)).value();
  return sum / static_cast<double>(errors_deg.size());
}

// The share of errors of at most u, integrated from 0 to t by its steps, over t.
double AreaUnderRecallCurve(std::vector<double> errors_deg, double t) {
  std::ranges::sort(errors_deg);
  double area = 0.0;
  for (size_t i = 0; i < errors_deg.size() && errors_deg[i] < t; ++i) {
    const double end = i + 1 < errors_deg.size() ? std::min(errors_deg[i + 1], t) : t;
    area += (end - errors_deg[i]) * static_cast<double>(i + 1) / static_cast<double>(errors_deg.size());
  }
  return area / t;
}

TEST(TrialMeasure, AreaIsTheIntegralOfTheRecallCurve) {
  RandomStream rng({.seed = 1, .purpose = 310});
  std::vector<double> errors_deg;
  for (int i = 0; i < 300; ++i) errors_deg.push_back(std::exp(1.5 + 1.5 * rng.Normal()));
  errors_deg.push_back(180.0);
  EXPECT_NEAR(ComputeMeanMeasure("auc_5_deg", errors_deg), AreaUnderRecallCurve(errors_deg, 5.0), 1e-12);
  EXPECT_NEAR(ComputeMeanMeasure("auc_10_deg", errors_deg), AreaUnderRecallCurve(errors_deg, 10.0), 1e-12);
  EXPECT_NEAR(ComputeMeanMeasure("auc_20_deg", errors_deg), AreaUnderRecallCurve(errors_deg, 20.0), 1e-12);
}

// Exponential errors of mean s: AUC@t = 1 - (s / t) (1 - e^(-t / s)), the accuracy at k is 1 - e^(-k / s).
// Their quantiles in the middle of 20,000 equal parts take the place of random numbers.
TEST(TrialMeasure, ClosedFormsOfExponentialErrors) {
  constexpr double kMeanDeg = 4.0;
  std::vector<double> errors_deg;
  for (int i = 0; i < 20'000; ++i) errors_deg.push_back(-kMeanDeg * std::log1p(-(i + 0.5) / 20'000));
  for (const auto& [name, t] :
       {std::pair<std::string, double>{"auc_5_deg", 5.0}, {"auc_10_deg", 10.0}, {"auc_20_deg", 20.0}}) {
    const double area = 1.0 - kMeanDeg / t * (1.0 - std::exp(-t / kMeanDeg));
    EXPECT_NEAR(ComputeMeanMeasure(name, errors_deg), area, 1e-4) << name;
  }
  double accuracy = 0.0;
  for (int k = 1; k <= 10; ++k) accuracy += (1.0 - std::exp(-k / kMeanDeg)) / 10.0;
  EXPECT_NEAR(ComputeMeanMeasure("maa_10_deg", errors_deg), accuracy, 1e-4);
}

TEST(TrialMeasure, ByHand) {
  const TrialRecord record = MakeAnsweredRecord(1.0, 2.5);
  EXPECT_DOUBLE_EQ(Find("auc_5_deg").Of(record).value(), 0.5);
  EXPECT_DOUBLE_EQ(Find("auc_10_deg").Of(record).value(), 0.75);
  EXPECT_DOUBLE_EQ(Find("auc_20_deg").Of(record).value(), 0.875);
  EXPECT_DOUBLE_EQ(Find("maa_10_deg").Of(record).value(), 0.8);  // within 3, 4, ..., 10 deg
  EXPECT_DOUBLE_EQ(Find("maa_10_deg").Of(MakeAnsweredRecord(3.0, 2.5)).value(), 0.8)
      << "at the threshold is within";
  EXPECT_DOUBLE_EQ(Find("maa_10_deg").Of(MakeAnsweredRecord(0.0, 0.0)).value(), 1.0);
  EXPECT_DOUBLE_EQ(Find("auc_5_deg").Of(MakeAnsweredRecord(5.0, 0.0)).value(), 0.0);
  EXPECT_DOUBLE_EQ(Find("auc_5_deg").Of(MakeAnsweredRecord(0.0, 180.0)).value(), 0.0);
  EXPECT_DOUBLE_EQ(Find("rotation_error_median_deg").Of(record).value(), 1.0);
  EXPECT_DOUBLE_EQ(Find("direction_error_median_deg").Of(record).value(), 2.5);
  EXPECT_DOUBLE_EQ(Find("max_error_median_deg").Of(record).value(), 2.5);
  EXPECT_DOUBLE_EQ(Find("max_error_median_deg").Of(MakeAnsweredRecord(7.0, 2.5)).value(), 7.0);
}

// Every status but ok, with errors that look perfect: none may count. A trial that does not count
// says nothing at all.
TEST(TrialMeasure, WhatIsNoMotionIsAsWrongAsCanBeOrLeftOut) {
  for (const MotionStatus status : AllStatuses()) {
    if (status == MotionStatus::kOk) continue;
    const TrialRecord record = Record(status, 0.0, 0.0);
    for (const TrialMeasure& measure : TrialScores()) {
      const bool is_left_out = !IsCounted(record) || (measure.leaves_out_refusals && HasRefused(record));
      EXPECT_EQ(measure.Of(record), is_left_out ? std::nullopt : std::optional<double>(0.0)) << measure.name;
    }
    for (const TrialMeasure& measure : TrialErrors()) {
      const bool is_left_out = !IsCounted(record) || (measure.leaves_out_refusals && HasRefused(record));
      EXPECT_EQ(measure.Of(record), is_left_out ? std::nullopt : std::optional<double>(kInfinity))
          << measure.name;
    }
  }
  EXPECT_EQ(Find("auc_5_deg_answered").Of(Record(MotionStatus::kInvalidMotion, kNaN, kNaN)), 0.0);
}

TEST(TrialMeasure, WhatIsNotKnownIsNotCounted) {
  for (const std::string suffix : {"", "_answered"}) {
    EXPECT_FALSE(Find("auc_5_deg" + suffix).Of(MakeAnsweredRecord(kNaN, kNaN)));
    EXPECT_FALSE(Find("max_error_median_deg" + suffix).Of(MakeAnsweredRecord(kNaN, kNaN)));
    // A truth without a direction: the rotation alone is scored.
    EXPECT_DOUBLE_EQ(Find("auc_5_deg" + suffix).Of(MakeAnsweredRecord(1.0, kNaN)).value(), 0.8);
    EXPECT_DOUBLE_EQ(Find("max_error_median_deg" + suffix).Of(MakeAnsweredRecord(1.0, kNaN)).value(), 1.0);
    EXPECT_FALSE(Find("direction_error_median_deg" + suffix).Of(MakeAnsweredRecord(1.0, kNaN)));
  }
}

}  // namespace
}  // namespace rcme
