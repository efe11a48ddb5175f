// How often the 95 % intervals for a population of conditions contain the truth (results/population; made by
// `scripts/results population_coverage`):
//   population_coverage FOLDER [REPETITIONS, default 4000]
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "stats/area_under_curve.h"
#include "stats/calibration_error.h"
#include "stats/constants.h"
#include "stats/distributions.h"
#include "stats/population_mean.h"
#include "stats/population_median.h"
#include "stats/population_rate.h"
#include "tests/test_support/condition_laws.h"

namespace rcme {
namespace {

using Shape = RateLaw::Shape;

// Results of one cell.
struct Coverage {
  std::int64_t n = 0, num_covered = 0, num_above = 0,
               num_below = 0;       // above: the truth is above the interval
  std::int64_t num_by_pooling = 0;  // covered by an interval that takes all trials for independent
  bool has_pooled = true;
  double width = 0.0;

  void Add(const Interval& interval, double truth, const Interval& pooled) {
    ++n;
    num_covered += interval.Contains(truth);
    num_above += interval.upper < truth;
    num_below += interval.lower > truth;
    num_by_pooling += pooled.Contains(truth);
    width += interval.upper - interval.lower;
  }
  double Share(std::int64_t count) const { return static_cast<double>(count) / static_cast<double>(n); }
  double value() const { return Share(num_covered); }
  // A dash where there is no such interval.
  std::string PooledText(double share, int digits) const {
    return has_pooled ? fmt::format("{:.{}f}", share, digits) : "-";
  }
};

struct Cell {
  std::string quantity, grid, regime, law, trials;
  int num_conditions = 0;
  double correlation = 0.0, truth = 0.0;
};

// The tables: a row per cell, and the extremes of the cells that are alike.
class Tables {
 public:
  void Add(const Cell& cell, const Coverage& c) {
    const Interval interval = ExactBinomialInterval(c.num_covered, c.n);
    cells_ += fmt::format("{},{},{},{},{},{},{},{:.6g},{},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4g},{}\n",
                          cell.quantity, cell.grid, cell.regime, cell.law, cell.num_conditions, cell.trials,
                          cell.correlation, cell.truth, c.n, c.value(), interval.lower, interval.upper,
                          c.Share(c.num_above), c.Share(c.num_below), c.width / static_cast<double>(c.n),
                          c.PooledText(c.Share(c.num_by_pooling), 4));
    Extremes& e = extremes_[{cell.quantity, cell.grid, cell.regime, cell.num_conditions}];
    ++e.num_cells;
    e.num_near += c.value() >= 0.93 && c.value() <= 0.97;
    e.least = std::min(e.least, c.value());
    e.greatest = std::max(e.greatest, c.value());
    e.least_by_pooling = std::min(e.least_by_pooling, c.Share(c.num_by_pooling));
    e.pooled_text = c.PooledText(e.least_by_pooling, 3);
  }

  std::string Cells() const {
    return "quantity,grid,regime,law,conditions,trials,correlation,truth,n,coverage,lower,upper,truth_above,"
           "truth_below,width,pooled_coverage\n" +
           cells_;
  }
  std::string Summary() const {
    std::string text = "quantity,grid,regime,conditions,cells,cells_near,least,greatest,least_pooled\n";
    for (const auto& [key, e] : extremes_) {
      const auto& [quantity, grid, regime, num_conditions] = key;
      text += fmt::format("{},{},{},{},{},{},{:.3f},{:.3f},{}\n", quantity, grid, regime, num_conditions,
                          e.num_cells, e.num_near, e.least, e.greatest, e.pooled_text);
    }
    return text;
  }

 private:
  struct Extremes {
    int num_cells = 0, num_near = 0;
    double least = 1.0, greatest = 0.0, least_by_pooling = 1.0;
    std::string pooled_text;
  };
  std::string cells_;
  std::map<std::tuple<std::string, std::string, std::string, int>, Extremes> extremes_;
};

RandomStream MakeStream(std::uint32_t cell, std::uint32_t purpose) {
  return RandomStream({.seed = 2, .trial = cell, .purpose = purpose});
}

// ---- rates

constexpr std::pair<const char*, Shape> kShapes[] = {{"beta", Shape::kBeta},
                                                     {"logit_normal", Shape::kLogitNormal},
                                                     {"never_or_high", Shape::kNeverOrHigh},
                                                     {"low_or_always", Shape::kLowOrAlways}};

// Trials of each condition: 60, 20, or 5 to 200 in turn, weighted by trials.
struct Sizes {
  const char* name;
  std::vector<int> cycle;
  ConditionWeights weights;
};

std::vector<int> ListTrials(const Sizes& sizes, int num_conditions) {
  std::vector<int> trials;
  for (int i = 0; i < num_conditions; ++i)
    trials.push_back(sizes.cycle[static_cast<size_t>(i) % sizes.cycle.size()]);
  return trials;
}

// hidden: of the conditions of the kind that fewer have, less than three are expected, and the others have
// events too, so that a sample without the few looks complete; rare: fewer than five events of the size that
// conditions give them are expected.
std::string ClassifyRegime(Shape shape, int num_conditions, double p, double rho) {
  if (rho > 0.0 && shape == Shape::kNeverOrHigh) {
    const double share_of_never = 1.0 - p / (p + rho * (1.0 - p));
    if (share_of_never < 0.5 && num_conditions * share_of_never < 3.0) return "hidden";
  }
  if (rho > 0.0 && shape == Shape::kLowOrAlways) {
    const double low = p * (1.0 - rho), share_of_always = (p - low) / (1.0 - low);
    if (share_of_always < 0.5 && num_conditions * share_of_always < 3.0) return "hidden";
  }
  const double size = 1.0 / 60.0 + rho * (1.0 - 1.0 / 60.0);
  return num_conditions * std::min(p, 1.0 - p) / size < 5.0 ? "rare" : "common";
}

void MeasureRateCell(const Cell& cell, const RateLaw& law, const Sizes& sizes, int repetitions,
                     std::uint32_t number, Tables* tables) {
  RandomStream rng = MakeStream(number, 160);
  const std::vector<int> trials = ListTrials(sizes, cell.num_conditions);
  Coverage coverage;
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    const PopulationRate rate = MeasurePopulationRate(DrawConditions(law, trials, rng), sizes.weights);
    coverage.Add(rate.interval, law.p(), ExactBinomialInterval(rate.num_events, rate.n));
  }
  tables->Add(cell, coverage);
}

void MeasureRates(const std::string& grid, const std::vector<int>& all_conditions,
                  const std::vector<double>& correlations, const std::vector<Sizes>& all_sizes,
                  int repetitions, std::uint32_t number, Tables* tables) {
  for (const double rho : correlations) {
    for (const auto& [name, shape] : kShapes) {
      if (rho == 0.0 && shape != Shape::kBeta) continue;  // one law
      for (const double p : {0.01, 0.05, 0.2, 0.5}) {
        const RateLaw law(shape, p, rho);
        for (const Sizes& sizes : all_sizes) {
          for (const int m : all_conditions) {
            const Cell cell{
                "rate", grid, ClassifyRegime(shape, m, p, rho), rho == 0.0 ? "equal" : name, sizes.name, m,
                rho,    p};
            MeasureRateCell(cell, law, sizes, repetitions, number++, tables);
          }
        }
      }
    }
  }
}

// ---- paired differences of rates

// The log odds of two estimators' failures in a condition: what both have in common and what each has alone.
// In half of the trials both fail together as far as their rates allow, in the others independently.
struct PairLaw {
  double common_sd, first, second, own_sd;
};
constexpr PairLaw kPairLaws[] = {{0, -1, -1, 0}, {0, -3, -2, 0}, {2, -3, -3, 1}, {2, -3, -2, 1},
                                 {4, -6, -4, 2}, {4, -2, -2, 3}, {1, 0, 0, 3}};

double Logistic(double x) { return 1.0 / (1.0 + std::exp(-x)); }

double MeanRate(double log_odds, double sd) {
  double sum = 0.0, weights = 0.0;
  for (int i = -4000; i <= 4000; ++i) {
    const double z = 0.002 * i, weight = std::exp(-0.5 * z * z);
    sum += weight * Logistic(log_odds + sd * z);
    weights += weight;
  }
  return sum / weights;
}

ConditionPair DrawPair(const PairLaw& law, RandomStream& rng) {
  const double common = law.common_sd * rng.Normal();
  const double p1 = Logistic(law.first + common + law.own_sd * rng.Normal());
  const double p2 = Logistic(law.second + common + law.own_sd * rng.Normal());
  const double first = 0.5 * (std::max(p1 - p2, 0.0) + p1 * (1.0 - p2));
  const double second = 0.5 * (std::max(p2 - p1, 0.0) + p2 * (1.0 - p1));
  ConditionPair pair{0, 0, 60};
  for (int i = 0; i < 60; ++i) {
    const double u = rng.Uniform();
    (u < first ? pair.num_first_only : pair.num_second_only) += u < first + second;
  }
  return pair;
}

void MeasureDifferences(int repetitions, Tables* tables) {
  std::uint32_t number = 0;
  for (const PairLaw& law : kPairLaws) {
    const double sd = std::hypot(law.common_sd, law.own_sd);
    const double truth = MeanRate(law.first, sd) - MeanRate(law.second, sd);
    for (const int m : {6, 30, 200}) {
      RandomStream rng = MakeStream(number++, 161);
      Coverage coverage;
      for (int repetition = 0; repetition < repetitions; ++repetition) {
        std::vector<ConditionPair> pairs;
        for (int i = 0; i < m; ++i) pairs.push_back(DrawPair(law, rng));
        const PopulationDifference difference = MeasurePopulationDifference(pairs);
        const double n = 60.0 * m, p1 = difference.first_only.value, p2 = difference.second_only.value;
        const double half = 1.96 * std::sqrt((p1 + p2 - std::pow(p1 - p2, 2.0)) / n);
        coverage.Add(difference.interval, truth, {difference.value - half, difference.value + half});
      }
      const std::string name =
          fmt::format("log odds {} and {} sd {} and {}", law.first, law.second, law.common_sd, law.own_sd);
      tables->Add({"difference", "asked", "common", name, "60", m, kNaN, truth}, coverage);
    }
  }
}

// ---- means

struct MeanLaw {
  const char* name;
  double truth;
  double (*draw)(RandomStream& rng);  // the mean of a condition
  double (*quantile)(double p);       // of that
};
const MeanLaw kMeanLaws[] = {
    {"normal", 0.0, [](RandomStream& rng) { return rng.Normal(); },
     [](double p) { return NormalQuantile(p); }},
    {"uniform", 0.0, [](RandomStream& rng) { return rng.Uniform(-1.7, 1.7); },
     [](double p) { return 1.7 * (2.0 * p - 1.0); }},
    {"exponential", 1.0, [](RandomStream& rng) { return -std::log(1.0 - rng.Uniform()); },
     [](double p) { return -std::log(1.0 - p); }},
    {"lognormal", 1.6487212707, [](RandomStream& rng) { return std::exp(rng.Normal()); },
     [](double p) { return std::exp(NormalQuantile(p)); }}};

void MeasureMeans(int repetitions, Tables* tables) {
  std::uint32_t number = 0;
  for (const MeanLaw& law : kMeanLaws) {
    for (const int m : {6, 30, 200}) {
      RandomStream rng = MakeStream(number++, 162);
      Coverage coverage;
      for (int repetition = 0; repetition < repetitions; ++repetition) {
        std::vector<Moments> conditions(static_cast<size_t>(m));
        Moments all;
        for (Moments& moments : conditions) {
          const double own = law.draw(rng);
          for (int i = 0; i < 20; ++i) moments.Add(own + rng.Normal());
          all.Merge(moments);
        }
        coverage.Add(MeasurePopulationMean(conditions).interval, law.truth, StudentInterval(all));
      }
      tables->Add({"mean", "asked", "common", law.name, "20", m, 0.5, law.truth}, coverage);
    }
  }
}

// ---- medians

// The law of the numbers of a population whose conditions have the means of a MeanLaw, each with standard
// normal noise.
double ComputeMedian(const MeanLaw& law) {
  constexpr int kNumStrata = 20'000;
  const auto share_up_to = [&](double x) {
    double sum = 0.0;
    for (int i = 0; i < kNumStrata; ++i) sum += NormalCdf(x - law.quantile((i + 0.5) / kNumStrata));
    return sum / kNumStrata;
  };
  double low = -10.0, high = 10.0;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (share_up_to(middle) < 0.5 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

void MeasureMedians(const std::string& grid, const std::vector<int>& all_conditions, int repetitions,
                    std::uint32_t number, Tables* tables) {
  for (const MeanLaw& law : kMeanLaws) {
    const double truth = ComputeMedian(law);
    for (const int m : all_conditions) {
      RandomStream rng = MakeStream(number++, 166);
      Coverage coverage;
      for (int repetition = 0; repetition < repetitions; ++repetition) {
        std::vector<StreamMedian> conditions(static_cast<size_t>(m));
        std::vector<const StreamMedian*> pointers;
        for (StreamMedian& numbers : conditions) {
          const double own = law.draw(rng);
          for (int i = 0; i < 20; ++i) numbers.Add(own + rng.Normal());
          pointers.push_back(&numbers);
        }
        const PopulationMedian median = MeasurePopulationMedian(pointers);
        coverage.Add(median.interval, truth, median.of_these_conditions);
      }
      tables->Add({"median", grid, "common", law.name, "20", m, 0.5, truth}, coverage);
    }
  }
}

// ---- expected calibration error

// Forecasts whose log odds are wrong by `error` and, condition by condition, by more.
struct ForecastLaw {
  const char* name;
  double error, error_sd, level, level_sd;
};
constexpr ForecastLaw kForecastLaws[] = {{"right", 0, 0, 0, 1},
                                         {"wrong by condition", 0, 1.5, 0, 1},
                                         {"wrong everywhere", 1, 1, 0, 1},
                                         {"rare events", 0.5, 1, -2, 1.5},
                                         {"rare events wrong by condition", 0, 2, -3, 1}};

std::vector<Forecast> DrawForecasts(const ForecastLaw& law, int num_conditions, int num_trials,
                                    RandomStream& rng) {
  std::vector<Forecast> forecasts;
  for (int condition = 0; condition < num_conditions; ++condition) {
    const double error = law.error + law.error_sd * rng.Normal();
    const double level = law.level + law.level_sd * rng.Normal();
    for (int i = 0; i < num_trials; ++i) {
      const double log_odds = level + rng.Normal();
      forecasts.push_back({Logistic(log_odds), rng.Uniform() < Logistic(log_odds + error), condition});
    }
  }
  return forecasts;
}

void MeasureCalibrationErrors(int repetitions, Tables* tables) {
  std::uint32_t number = 0;
  for (const ForecastLaw& law : kForecastLaws) {
    RandomStream truth_rng = MakeStream(number, 163);
    const double truth = ExpectedCalibrationError(
        BinForecasts(DrawForecasts(law, 400'000, 5, truth_rng), Binning::kEqualWidth, 10));
    for (const int m : {6, 30, 200}) {
      RandomStream rng = MakeStream(number, 164), samples = MakeStream(number, 165);
      ++number;
      Coverage coverage;
      coverage.has_pooled = false;
      for (int repetition = 0; repetition < repetitions; ++repetition) {
        const BootstrapEstimate error = MeasurePopulationCalibrationError(
            DrawForecasts(law, m, 60, rng), Binning::kEqualWidth, 10, {.num_samples = 300}, samples);
        coverage.Add(error.interval, truth, {});
      }
      tables->Add({"calibration_error", "asked", "common", law.name, "60", m, kNaN, truth}, coverage);
    }
  }
}

// ---- area under the curve of failures against successes, by stated probability

std::vector<ScoreCluster> ClusterByCondition(const std::vector<Forecast>& forecasts, int num_conditions) {
  std::vector<ScoreCluster> clusters(static_cast<size_t>(num_conditions));
  for (const Forecast& forecast : forecasts) {
    ScoreCluster& cluster = clusters[static_cast<size_t>(forecast.cluster)];
    (forecast.happened ? cluster.positives : cluster.negatives).push_back(forecast.probability);
  }
  return clusters;
}

void MeasureAreas(int repetitions, Tables* tables) {
  constexpr int kManyConditions = 400'000;
  std::uint32_t number = 0;
  for (const ForecastLaw& law : kForecastLaws) {
    RandomStream truth_rng = MakeStream(number, 167);
    const double truth =
        MeasureClusteredAreaUnderCurve(
            ClusterByCondition(DrawForecasts(law, kManyConditions, 5, truth_rng), kManyConditions))
            .value;
    for (const int m : {6, 30, 200}) {
      RandomStream rng = MakeStream(number++, 168);
      Coverage coverage;
      coverage.has_pooled = false;
      for (int repetition = 0; repetition < repetitions; ++repetition) {
        const std::vector<Forecast> forecasts = DrawForecasts(law, m, 60, rng);
        const auto num_failed = std::ranges::count(forecasts, true, &Forecast::happened);
        const bool has_both = num_failed > 0 && num_failed < std::ssize(forecasts);
        coverage.Add(has_both ? MeasureClusteredAreaUnderCurve(ClusterByCondition(forecasts, m)).interval
                              : Interval{0.0, 1.0},
                     truth, {});
      }
      tables->Add({"area_under_curve", "asked", "common", law.name, "60", m, kNaN, truth}, coverage);
    }
  }
}

bool Write(const std::string& path, const std::string& text) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  if (file == nullptr) return false;
  const bool is_written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
  return std::fclose(file) == 0 && is_written;
}

bool Measure(const std::string& folder, int repetitions) {
  Tables tables;
  const Sizes each_60{"60", {60}, ConditionWeights::kEqual}, each_20{"20", {20}, ConditionWeights::kEqual};
  const Sizes unequal{"5 to 200", {5, 20, 60, 200}, ConditionWeights::kByTrials};
  MeasureRates("asked", {6, 30, 200}, {0.0, 0.3, 0.7}, {each_60}, repetitions, 0, &tables);
  MeasureRates("other", {12, 100}, {0.0, 0.1, 0.5}, {each_20, unequal}, repetitions, 1000, &tables);
  MeasureDifferences(repetitions, &tables);
  MeasureMeans(repetitions, &tables);
  MeasureMedians("asked", {6, 30, 200}, repetitions, 0, &tables);
  MeasureMedians("other", {12, 100}, repetitions, 1000, &tables);
  MeasureCalibrationErrors(std::max(1, repetitions / 4), &tables);
  MeasureAreas(std::max(1, repetitions / 4), &tables);
  return Write(folder + "/population_coverage.csv", tables.Cells()) &&
         Write(folder + "/population_summary.csv", tables.Summary());
}

}  // namespace
}  // namespace rcme

int main(int argc, char** argv) {
  int repetitions = 4000;
  bool is_good = argc == 2 || argc == 3;
  if (argc == 3) {
    const std::string_view text = argv[2];
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), repetitions);
    is_good = error == std::errc() && end == text.data() + text.size() && repetitions >= 1;
  }
  if (!is_good) {
    fmt::print(stderr, "usage: population_coverage FOLDER [REPETITIONS]\n");
    return 2;
  }
  if (rcme::Measure(argv[1], repetitions)) return 0;
  fmt::print(stderr, "population_coverage: cannot write to {}\n", argv[1]);
  return 1;
}
