#include "experiments/statistics/forecast_measures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "stats/constants.h"
#include "stats/population_rate.h"
#include "stats/random.h"
#include "stats/risk_coverage_area.h"

namespace rcme {
namespace {

constexpr int kNumHistogramBins = 20, kNumCalibrationSamples = 399;
// For outcomes drawn here; the streams of trials have other purposes (data_source.h).
constexpr std::uint32_t kPurposeOfDrawnOutcomes = 200, kPurposeOfDrawnConditions = 201;

double MeanProbability(const std::vector<Forecast>& forecasts) {
  double sum = 0.0;
  for (const Forecast& forecast : forecasts) sum += forecast.probability;
  return sum / static_cast<double>(forecasts.size());
}

AreaUnderCurve MeasureForecastArea(std::vector<Forecast> forecasts, const ClusteredEstimate& failure) {
  if (failure.value == 0.0 || failure.value == 1.0) return {kNaN, kNaN, {0.0, 1.0}};
  std::ranges::stable_sort(forecasts, {}, &Forecast::cluster);
  std::vector<ScoreCluster> clusters;
  for (size_t i = 0; i < forecasts.size(); ++i) {
    if (i == 0 || forecasts[i].cluster != forecasts[i - 1].cluster) clusters.emplace_back();
    ScoreCluster& cluster = clusters.back();
    (forecasts[i].happened ? cluster.positives : cluster.negatives).push_back(forecasts[i].probability);
  }
  return MeasureClusteredAreaUnderCurve(clusters);
}

// Ranks answers by probability, surest first, and refusals last.
std::vector<ClusteredOutcome> ListOutcomes(const FailureForecasts& of) {
  std::vector<ClusteredOutcome> outcomes;
  for (const Forecast& forecast : of.forecasts)
    outcomes.push_back({-forecast.probability, forecast.happened, forecast.cluster});
  for (const std::int64_t scene : of.refused_clusters)
    outcomes.push_back({-std::numeric_limits<double>::infinity(), true, scene});
  return outcomes;
}

void MeasureRiskCoverage(const FailureForecasts& of, ForecastMeasures* measures) {
  const std::vector<ClusteredOutcome> outcomes = ListOutcomes(of);
  measures->risk_coverage_area = MeasureRiskCoverageArea(outcomes);
  std::vector<ScoredOutcome> scored;
  for (const ClusteredOutcome& outcome : outcomes) scored.push_back({outcome.score, outcome.failed});
  measures->risk_coverage = RiskCoverageCurve(std::move(scored));
}

// Counts events and trials, in total and by cluster.
class ClusterCounts {
 public:
  void Add(std::int64_t cluster, bool has_happened) {
    ConditionCount& counts = of_cluster_[cluster];
    ++counts.num_trials;
    counts.num_events += has_happened;
    ++n_;
    num_events_ += has_happened;
  }
  std::int64_t num_events() const { return num_events_; }
  // Exact if each trial is a cluster of its own and not the draw of a population.
  Interval FindInterval(bool is_of_population) const {
    const bool is_independent = std::ssize(of_cluster_) == n_;
    if (is_independent && !is_of_population) return ExactBinomialInterval(num_events_, n_);
    std::vector<ConditionCount> counts;
    for (const auto& [cluster, of_cluster] : of_cluster_) counts.push_back(of_cluster);
    return MeasurePopulationRate(counts, ConditionWeights::kByTrials).interval;
  }

 private:
  std::map<std::int64_t, ConditionCount> of_cluster_;
  std::int64_t n_ = 0, num_events_ = 0;
};

void CountRates(const FailureForecasts& of, ForecastMeasures* measures) {
  ClusterCounts failed, sure, sure_failed;
  for (const Forecast& forecast : of.forecasts) {
    const bool is_sure = forecast.probability <= kSureBelow;
    failed.Add(forecast.cluster, forecast.happened);
    sure.Add(forecast.cluster, is_sure);
    if (is_sure) sure_failed.Add(forecast.cluster, forecast.happened);
  }
  for (const std::int64_t cluster : of.refused_clusters) sure.Add(cluster, false);
  if (of.is_of_population) measures->failure.interval = failed.FindInterval(true);
  measures->num_sure = sure.num_events();
  measures->num_sure_failed = sure_failed.num_events();
  measures->sure_interval = sure.FindInterval(of.is_of_population);
  measures->sure_failed_interval = sure_failed.FindInterval(of.is_of_population);
}

std::vector<std::int64_t> CountHistogram(const std::vector<Forecast>& forecasts) {
  const std::vector<double> edges = HistogramEdges();
  std::vector<std::int64_t> counts(kNumHistogramBins, 0);
  for (const Forecast& forecast : forecasts) {
    const auto above = std::ranges::upper_bound(edges, forecast.probability);
    ++counts[std::min<size_t>(static_cast<size_t>(above - edges.begin()), kNumHistogramBins) - 1];
  }
  return counts;
}

// Clusters for simulating outcomes of correct probabilities: the trials of a scene are drawn together; the
// scenes of a draw are independent of each other.
std::vector<Forecast> WithScenes(const FailureForecasts& of) {
  std::vector<Forecast> forecasts = of.forecasts;
  std::map<std::pair<std::int64_t, std::int64_t>, std::int64_t> number_of;  // of (draw, scene)
  for (size_t i = 0; of.is_of_population && i < forecasts.size(); ++i) {
    const std::pair scene(forecasts[i].cluster, of.scenes[i]);
    forecasts[i].cluster = number_of.try_emplace(scene, std::ssize(number_of)).first->second;
  }
  return forecasts;
}

// Uses the same stream for all, so equal forecasts have equal samples.
void MeasureCalibration(const FailureForecasts& of, std::uint64_t seed, ForecastMeasures* measures) {
  const std::vector<Forecast> forecasts = WithScenes(of);
  RandomStream rng({.seed = seed, .purpose = kPurposeOfDrawnOutcomes});
  measures->parts = DecomposeBrierScore(forecasts);
  measures->curve = ReliabilityCurve(forecasts);
  measures->check = CheckCalibration(forecasts, BandProbabilities(), kNumCalibrationSamples, rng);
  measures->bins = BinForecasts(forecasts, Binning::kEqualWidth, kNumCalibrationBins);
  measures->error_of_equal_width = MeasureCalibrationError(forecasts, Binning::kEqualWidth,
                                                           kNumCalibrationBins, kNumCalibrationSamples, rng);
  measures->error_of_equal_mass = MeasureCalibrationError(forecasts, Binning::kEqualMass, kNumCalibrationBins,
                                                          kNumCalibrationSamples, rng);
  // They are fitted to answers of the same run, so that the p value of right ones would not be uniform.
  if (of.source == ForecastSource::kInlierShare)
    measures->check.p_value = measures->error_of_equal_width.p_value = measures->error_of_equal_mass.p_value =
        kNaN;
  measures->line = FitCalibrationLine(of.forecasts);
  if (!of.is_of_population) return;
  RandomStream samples({.seed = seed, .purpose = kPurposeOfDrawnConditions});
  const BootstrapOptions options{.chance_bias = ChanceBias::kUpwards};
  measures->interval_of_equal_width = MeasurePopulationCalibrationError(of.forecasts, Binning::kEqualWidth,
                                                                        kNumCalibrationBins, options, samples)
                                          .interval;
}

}  // namespace

std::vector<double> BandProbabilities() {
  std::vector<double> probabilities = {0.0, 1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2};
  for (int i = 1; i <= 50; ++i) probabilities.push_back(i / 50.0);
  return probabilities;
}

std::vector<double> HistogramEdges() {
  std::vector<double> edges;
  for (int k = 0; k <= kNumHistogramBins; ++k)
    edges.push_back(std::pow(static_cast<double>(k) / kNumHistogramBins, 2.0));
  return edges;
}

ForecastMeasures MeasureForecasts(const FailureForecasts& of, std::uint64_t seed) {
  ForecastMeasures measures;
  measures.estimator = of.estimator;
  measures.group = of.group;
  measures.source = of.source;
  measures.is_of_population = of.is_of_population;
  measures.n = std::ssize(of.forecasts);
  measures.num_refused = std::ssize(of.refused_clusters);
  measures.num_without = of.num_without;
  if (measures.n == 0) return measures;
  measures.mean_probability = MeanProbability(of.forecasts);
  measures.failure = MeasureShareHappened(of.forecasts);
  measures.brier = MeasureBrierScore(of.forecasts);
  measures.log_score = MeasureLogScore(of.forecasts);
  measures.histogram = CountHistogram(of.forecasts);
  measures.area = MeasureForecastArea(of.forecasts, measures.failure);
  MeasureCalibration(of, seed, &measures);
  MeasureRiskCoverage(of, &measures);
  CountRates(of, &measures);
  return measures;
}

std::vector<ForecastMeasures> MeasureFailureForecasts(std::span<const ResultStore> runs,
                                                      const std::string& by) {
  std::vector<FailureForecasts> forecasts;
  for (const ResultStore& run : runs) AddForecastsOfRun(CollectFailureForecasts(run, by), &forecasts);
  std::vector<ForecastMeasures> all;
  for (const FailureForecasts& of : forecasts)
    all.push_back(MeasureForecasts(of, runs.front().Description().seed));
  return all;
}

std::vector<ForecastMeasures> MeasureFailureForecasts(const ResultStore& run, const std::string& by) {
  return MeasureFailureForecasts(std::span(&run, 1), by);
}

}  // namespace rcme
