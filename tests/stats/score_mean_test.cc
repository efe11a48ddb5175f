// Known answers, score by score from the definition: python3 tests/known_answers/score_mean.py
#include "stats/score_mean.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "stats/confidence_sequence.h"
#include "stats/distributions.h"
#include "stats/moments.h"
#include "stats/random.h"
#include "tests/test_support/coverage_count.h"

namespace rcme {
namespace {

ScoreMean ComputeScoreMean(const std::vector<std::pair<double, int>>& scores,
                           const Interval& range = {0.0, 1.0}) {
  ScoreMean mean(range);
  for (const auto& [score, count] : scores) mean.Add(score, count);
  return mean;
}

TEST(ScoreMean, KnownAnswers) {
  const struct {
    std::vector<std::pair<double, int>> scores;
    double confidence;
    Interval range;
    double lower, upper, mean, p_value;
  } kKnown[] = {
      {{{1.0, 10}}, 0.95, {0, 1}, 0.5628472719, 1.0, 0.5, 0.01742932588},
      {{{0.0, 3}, {0.9, 57}}, 0.95, {0, 1}, 0.7244805481, 0.8968234330, 0.75, 0.1827175127},
      {{{0.25, 40}, {0.5, 40}, {0.75, 40}}, 0.99, {0, 1}, 0.4327408049, 0.5672591951, 0.55, 0.1779495053},
      {{{-1.0, 2}, {0.0, 80}, {0.5, 18}}, 0.95, {-1, 1}, -0.0303711922, 0.1511978521, 0.0, 0.3441064077},
      {{{-0.1, 50}, {0.3, 50}}, 0.95, {-1, 1}, 0.0216798847, 0.1701546506, 0.0, 0.008087178411}};
  for (const auto& known : kKnown) {
    const ScoreMean mean = ComputeScoreMean(known.scores, known.range);
    const Interval interval = mean.Sequence(known.confidence);
    const double width = known.upper - known.lower;
    EXPECT_NEAR(interval.lower, known.lower, 1e-3 * width);
    EXPECT_NEAR(interval.upper, known.upper, 1e-3 * width);
    EXPECT_LE(interval.lower, known.lower + 1e-9) << "rounded outwards";
    EXPECT_GE(interval.upper, known.upper - 1e-9) << "rounded outwards";
    EXPECT_NEAR(mean.PValue(known.mean), known.p_value, 1e-8 * known.p_value);
  }
}

TEST(ScoreMean, OneSidedPValues) {
  const ScoreMean mean = ComputeScoreMean({{0.0, 3}, {0.9, 57}});
  double at_most_before = 0.0, at_least_before = 1.0;
  for (const double m : {0.5, 0.7, 0.8, 0.855, 0.9, 0.95}) {
    const double at_most = mean.PValueOfAtMost(m), at_least = mean.PValueOfAtLeast(m);
    EXPECT_GE(at_most, at_most_before) << m;
    EXPECT_LE(at_least, at_least_before) << m;
    EXPECT_DOUBLE_EQ(mean.PValue(m), std::min(1.0, 2.0 * std::min(at_most, at_least))) << m;
    at_most_before = at_most;
    at_least_before = at_least;
  }
  const Interval interval = mean.Sequence(0.9);
  EXPECT_LE(mean.PValueOfAtMost(interval.lower), 0.05 + 1e-9) << "the bound is rounded outwards";
  EXPECT_LE(mean.PValueOfAtLeast(interval.upper), 0.05 + 1e-9);
  EXPECT_EQ(ScoreMean().PValueOfAtMost(0.5), 1.0);
  EXPECT_THROW(mean.PValueOfAtLeast(1.0), std::invalid_argument);
}

TEST(ScoreMean, KeepsTheMeanAndRefusesWhatIsNoScore) {
  ScoreMean mean;
  EXPECT_TRUE(std::isnan(mean.mean()));
  EXPECT_EQ(mean.Sequence().lower, 0.0);
  EXPECT_EQ(mean.Sequence().upper, 1.0);
  EXPECT_EQ(mean.PValue(0.5), 1.0);
  mean.Add(0.123), mean.Add(0.7771, 2), mean.Add(1.0), mean.Add(0.5, 0);
  EXPECT_EQ(mean.n(), 4);
  EXPECT_DOUBLE_EQ(mean.mean(), (0.123 + 2 * 0.7771 + 1.0) / 4.0);
  for (const double bad : {-1e-9, 1.0 + 1e-9, std::nan("")})
    EXPECT_THROW(mean.Add(bad), std::invalid_argument);
  for (const double bad : {0.0, 1.0, std::nan("")}) EXPECT_THROW(mean.PValue(bad), std::invalid_argument);
  // All scores at an end: nothing beyond it, the mean inside.
  EXPECT_EQ(ComputeScoreMean({{0.0, 30}}).Sequence().lower, 0.0);
  EXPECT_GT(ComputeScoreMean({{0.0, 30}}).Sequence().upper, 0.05);
  EXPECT_EQ(ComputeScoreMean({{1.0, 30}}, {-1, 1}).Sequence().upper, 1.0);
}

// A score between two points of the grid is divided between them: never a narrower interval than of the
// scores themselves, and hardly a wider one.
TEST(ScoreMean, TheGridOnlyWidens) {
  ScoreMean between, on_the_grid;
  for (int i = 0; i < 50; ++i) {
    between.Add(0.805), between.Add(0.425);
    on_the_grid.Add(0.80), on_the_grid.Add(0.81), on_the_grid.Add(0.42), on_the_grid.Add(0.43);
  }
  EXPECT_NEAR(between.mean(), on_the_grid.mean(), 1e-12);
  // By definition, with the scores as they are and K as in the header; its bounds lie inside.
  const auto log_capital = [](double m) {
    double most = 0.0;
    for (const double f :
         {0.95, 0.85, 0.7, 0.55, 0.4, 0.28, 0.2, 0.14, 0.1, 0.07, 0.05, 0.025, 0.0125, 0.00625})
      most += std::pow(1.0 + f * (0.805 / m - 1.0), 50) * std::pow(1.0 + f * (0.425 / m - 1.0), 50) / 14.0;
    return std::log(most);
  };
  const Interval interval = between.Sequence();
  EXPECT_GE(log_capital(interval.lower), std::log(40.0));
  EXPECT_LT(log_capital(interval.lower + 0.02 * (interval.upper - interval.lower)), std::log(40.0));
}

TEST(ScoreMean, PValueAndIntervalAreOneTest) {
  RandomStream rng({.seed = 1, .purpose = 300});
  ScoreMean mean({-1.0, 1.0});
  for (int i = 0; i < 200; ++i) mean.Add(std::clamp(0.1 + 0.4 * rng.Normal(), -1.0, 1.0));
  for (const double confidence : {0.5, 0.9, 0.95, 0.999}) {
    const Interval interval = mean.Sequence(confidence);
    const double step = 1e-2 * (interval.upper - interval.lower);
    EXPECT_LE(mean.PValue(interval.lower - step), 1.0 - confidence);
    EXPECT_GT(mean.PValue(interval.lower + step), 1.0 - confidence);
    EXPECT_LE(mean.PValue(interval.upper + step), 1.0 - confidence);
    EXPECT_GT(mean.PValue(interval.upper - step), 1.0 - confidence);
  }
}

// A score is 0 with probability p, else 0.9. Exact sums over the number of zeros: the interval covers at
// least 95 % for every p and n, while Student's, mean +- t s / sqrt(n), covers as little as 0.63.
TEST(ScoreMean, CoversWhereStudentDoesNot) {
  double least_of_student = 1.0;
  for (const int n : {20, 100, 400}) {
    for (const double p : {0.01, 0.03, 0.1, 0.5}) {
      double covered = 0.0, covered_by_student = 0.0;
      for (int zeros = 0; zeros <= n; ++zeros) {
        const double mass = BinomialCdf(zeros, n, p) - BinomialCdf(zeros - 1, n, p);
        if (mass < 1e-12) continue;
        const double truth = 0.9 * (1.0 - p);
        Moments moments;
        for (int i = 0; i < n; ++i) moments.Add(i < zeros ? 0.0 : 0.9);
        covered += mass * ComputeScoreMean({{0.0, zeros}, {0.9, n - zeros}}).Sequence().Contains(truth);
        covered_by_student += mass * StudentInterval(moments).Contains(truth);
      }
      EXPECT_GE(covered, 0.95) << n << " scores, " << p;
      least_of_student = std::min(least_of_student, covered_by_student);
    }
  }
  EXPECT_LT(least_of_student, 0.7);
}

struct Law {
  const char* name;
  double mean;
  std::function<double(RandomStream&)> draw;
};

// Scores as they come, off the grid: none, one or two kinds at once, skewed either way.
const std::vector<Law>& Laws() {
  static const std::vector<Law> laws = {
      {"AUC of an estimator that fails in 5 %", 0.95 * (1.0 - 0.2 / 2.0),
       [](RandomStream& rng) { return rng.Uniform() < 0.05 ? 0.0 : 1.0 - 0.2 * rng.Uniform(); }},
      {"fails mostly", 0.1 * 0.5,
       [](RandomStream& rng) { return rng.Uniform() < 0.9 ? 0.0 : rng.Uniform(); }},
      {"square", 1.0 / 3.0, [](RandomStream& rng) { return std::pow(rng.Uniform(), 2.0); }},
      {"a third root", 0.75, [](RandomStream& rng) { return std::cbrt(rng.Uniform()); }}};
  return laws;
}

// 500 samples per law and n; asserted is that the coverage is not below 95 % beyond chance (1e-4 each).
TEST(ScoreMean, CoversForEveryLaw) {
  std::uint32_t condition = 0;
  for (const Law& law : Laws()) {
    for (const int n : {10, 60, 300}) {
      CoverageCount covered;
      for (std::uint32_t sample = 0; sample < 500; ++sample) {
        RandomStream rng({.seed = 1, .condition = condition, .trial = sample, .purpose = 301});
        ScoreMean mean;
        for (int i = 0; i < n; ++i) mean.Add(law.draw(rng));
        covered.Add(mean.Sequence().Contains(law.mean));
      }
      EXPECT_GE(covered.interval().upper, 0.95) << law.name << ", n = " << n << ": " << covered;
      ++condition;
    }
  }
}

// Looked at after every score, the p-value of the true mean ever falls to 0.05 in at most 5 % of the studies;
// Student's test, looked at so, does in 40 % of those of the skewed law.
TEST(ScoreMean, WatchedAfterEveryScoreItErrsAtMostAsOftenAsItSays) {
  for (const Law& law : {Laws()[0], Laws()[2]}) {
    CoverageCount rejects, student_rejects;
    for (std::uint32_t study = 0; study < 400; ++study) {
      RandomStream rng({.seed = 1, .trial = study, .purpose = 302});
      ScoreMean mean;
      Moments moments;
      bool has_rejected = false, has_student_rejected = false;
      for (int n = 1; n <= 200; ++n) {
        const double score = law.draw(rng);
        mean.Add(score), moments.Add(score);
        has_rejected = has_rejected || mean.PValue(law.mean) <= 0.05;
        has_student_rejected =
            has_student_rejected || (n >= 10 && !StudentInterval(moments).Contains(law.mean));
      }
      rejects.Add(has_rejected), student_rejects.Add(has_student_rejected);
    }
    EXPECT_LE(rejects.interval().lower, 0.05) << law.name << ": " << rejects;
    RecordProperty("rejects", std::to_string(rejects.rate()) + " " + std::to_string(student_rejects.rate()));
    EXPECT_GT(student_rejects.interval().lower, 0.15) << law.name << ": " << student_rejects;
  }
}

// What it costs: with 1,000 scores of an estimator that fails in 5 %, less than 3.8 standard errors below and
// 3 above, where Student's takes 1.96; and it finds a difference of 0.1 with standard deviation 0.4 among
// 400.
TEST(ScoreMean, IsNarrowEnoughToBeOfUse) {
  RandomStream rng({.seed = 1, .purpose = 303});
  ScoreMean mean, difference({-1.0, 1.0});
  Moments moments;
  for (int i = 0; i < 1000; ++i) {
    const double score = Laws()[0].draw(rng);
    mean.Add(score), moments.Add(score);
  }
  const Interval interval = mean.Sequence();
  EXPECT_LT(mean.mean() - interval.lower, 3.9 * moments.standard_error());
  EXPECT_LT(interval.upper - mean.mean(), 3.1 * moments.standard_error());
  difference.Add(0.5, 240), difference.Add(-0.5, 160);
  EXPECT_LT(difference.PValue(0.0), 0.01);
}

// At the confidence of an audit, where one look at fixed n takes 4 standard errors, uniform numbers cost less
// than 5.6; and the less they scatter the less, also than counts with as much scatter as a coin's.
TEST(ScoreMean, IsNarrowerTheLessTheScoresScatter) {
  constexpr double kConfidence = 1.0 - 6e-5;
  constexpr int kScores = 20'000;
  ScoreMean uniform, narrow;
  for (int i = 0; i < kScores; ++i) {
    const double at = (i + 0.5) / kScores;
    uniform.Add(at), narrow.Add(0.45 + 0.1 * at);
  }
  const ScoreMean coin = ComputeScoreMean({{0.0, kScores / 2}, {1.0, kScores / 2}});
  const auto width = [](const ScoreMean& mean) { return mean.Sequence(kConfidence).upper - mean.mean(); };
  EXPECT_NEAR(uniform.standard_deviation(), std::sqrt(1.0 / 12.0), 1e-4);
  EXPECT_NEAR(ComputeScoreMean({{-1.0, 30}, {1.0, 30}}, {-1.0, 1.0}).standard_deviation(), 1.0, 1e-12);
  EXPECT_LT(width(uniform), 5.6 * uniform.standard_deviation() / std::sqrt(kScores));
  EXPECT_GT(width(uniform), 4.0 * uniform.standard_deviation() / std::sqrt(kScores));
  EXPECT_LT(width(narrow), 0.25 * width(uniform));
  EXPECT_LT(width(coin), 1.15 * (ConfidenceSequence(kScores / 2, kScores, kConfidence).upper - 0.5));
}

}  // namespace
}  // namespace rcme
