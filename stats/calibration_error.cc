#include "stats/calibration_error.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "stats/population_rate.h"

namespace rcme {
namespace {

// The number of each forecast's bin, from 0, rising with the probability; bins may be empty.
std::vector<size_t> BinNumbers(std::span<const Forecast> forecasts, Binning binning, int num_bins) {
  CheckForecasts(forecasts);
  if (num_bins < 1) throw std::invalid_argument("calibration error: at least one bin is needed");
  const size_t n = forecasts.size(), K = static_cast<size_t>(num_bins);
  std::vector<size_t> numbers(n);
  if (binning == Binning::kEqualWidth) {
    for (size_t i = 0; i < n; ++i) {
      const double place = std::floor(forecasts[i].probability * num_bins);
      numbers[i] = std::min(static_cast<size_t>(place), K - 1);
    }
    return numbers;
  }
  std::vector<size_t> order(n);
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return forecasts[a].probability < forecasts[b].probability; });
  for (size_t rank = 0; rank < n; ++rank) {
    const bool is_tie =
        rank > 0 && forecasts[order[rank]].probability == forecasts[order[rank - 1]].probability;
    numbers[order[rank]] = is_tie ? numbers[order[rank - 1]] : rank * K / n;
  }
  return numbers;
}

struct Bin {
  double sum = 0.0, num_happened = 0.0;  // sum of the probabilities; number of events
};

// The calibration error of bins with probabilities and events.
double ComputeBinnedError(const std::vector<Bin>& bins, double n) {
  double error = 0.0;
  for (const Bin& bin : bins) error += std::abs(bin.sum - bin.num_happened) / n;
  return error;
}

template <typename Happened>
void SetOutcomes(const std::vector<size_t>& numbers, Happened&& happened, std::vector<Bin>* bins) {
  for (Bin& bin : *bins) bin.num_happened = 0.0;
  for (size_t i = 0; i < numbers.size(); ++i) (*bins)[numbers[i]].num_happened += happened(i) ? 1.0 : 0.0;
}

}  // namespace

std::vector<CalibrationBin> BinForecasts(std::span<const Forecast> forecasts, Binning binning, int num_bins) {
  const std::vector<size_t> numbers = BinNumbers(forecasts, binning, num_bins);
  std::vector<CalibrationBin> bins(static_cast<size_t>(num_bins));
  for (size_t i = 0; i < forecasts.size(); ++i) {
    const double p = forecasts[i].probability;
    CalibrationBin& bin = bins[numbers[i]];
    bin.least = bin.n == 0 ? p : std::min(bin.least, p);
    bin.greatest = std::max(bin.greatest, p);
    ++bin.n;
    bin.num_happened += forecasts[i].happened ? 1 : 0;
    bin.mean_probability += (p - bin.mean_probability) / static_cast<double>(bin.n);
  }
  std::erase_if(bins, [](const CalibrationBin& bin) { return bin.n == 0; });
  for (CalibrationBin& bin : bins) {
    bin.share = static_cast<double>(bin.num_happened) / static_cast<double>(bin.n);
    bin.interval = ExactBinomialInterval(bin.num_happened, bin.n);
  }
  return bins;
}

double ExpectedCalibrationError(std::span<const CalibrationBin> bins) {
  double error = 0.0, n = 0.0;
  for (const CalibrationBin& bin : bins) {
    n += static_cast<double>(bin.n);
    error += static_cast<double>(bin.n) * std::abs(bin.mean_probability - bin.share);
  }
  return error / n;
}

MeasuredCalibrationError MeasureCalibrationError(std::span<const Forecast> forecasts, Binning binning,
                                                 int num_bins, int num_samples, RandomStream& rng) {
  if (num_samples < 1) throw std::invalid_argument("calibration error: at least one sample is needed");
  const std::vector<size_t> numbers = BinNumbers(forecasts, binning, num_bins);
  const double n = static_cast<double>(forecasts.size());
  std::vector<Bin> bins(static_cast<size_t>(num_bins));
  for (size_t i = 0; i < forecasts.size(); ++i) bins[numbers[i]].sum += forecasts[i].probability;
  SetOutcomes(
      numbers, [&](size_t i) { return forecasts[i].happened; }, &bins);
  MeasuredCalibrationError error;
  error.value = ComputeBinnedError(bins, n);
  const std::vector<std::int64_t> clusters = NumberedClusters(forecasts);
  std::vector<double> errors;
  int num_as_great = 0;
  for (int sample = 0; sample < num_samples; ++sample) {
    const std::vector<bool> outcomes = DrawOutcomes(forecasts, clusters, rng);
    SetOutcomes(
        numbers, [&](size_t i) { return outcomes[i]; }, &bins);
    errors.push_back(ComputeBinnedError(bins, n));
    num_as_great += errors.back() >= error.value - 1e-12 ? 1 : 0;  // equal but for rounding
  }
  error.p_value = (1.0 + num_as_great) / (1.0 + num_samples);
  error.mean_if_calibrated = std::accumulate(errors.begin(), errors.end(), 0.0) / num_samples;
  std::sort(errors.begin(), errors.end());
  error.upper_if_calibrated = errors[static_cast<size_t>(0.95 * (num_samples - 1) + 0.5)];
  return error;
}

namespace {

constexpr std::int64_t kFewClusters = 5;

// See the header; nothing changes where enough clusters had an event and a non-event.
void WidenForUnseenEvents(std::span<const Forecast> forecasts, const std::vector<ConditionCount>& counts,
                          BootstrapEstimate* error) {
  const auto num_with = std::ranges::count_if(counts, [](const auto&c) { return c.num_events > 0; }),
             num_without =
                 std::ranges::count_if(counts, [](const auto&c) { return c.num_events < c.num_trials; });
  if (std::min(num_with, num_without) >= kFewClusters) return;
  const PopulationRate rate = MeasurePopulationRate(counts, ConditionWeights::kByTrials);
  double stated = 0.0;
  for (const Forecast& forecast : forecasts)
    stated += forecast.probability / static_cast<double>(forecasts.size());
  const double beyond = std::max({0.0, rate.interval.lower - stated, stated - rate.interval.upper});
  const double unseen = std::max(rate.interval.upper - rate.value, rate.value - rate.interval.lower);
  error->interval.lower = std::min(error->interval.lower, beyond);
  error->interval.upper = std::max(error->interval.upper, std::min(1.0, error->value + unseen));
}

}  // namespace

BootstrapEstimate MeasurePopulationCalibrationError(std::span<const Forecast> forecasts, Binning binning,
                                                    int num_bins, const BootstrapOptions& given,
                                                    RandomStream& rng) {
  const std::vector<size_t> bin_numbers = BinNumbers(forecasts, binning, num_bins);
  const std::vector<std::int64_t> clusters = NumberedClusters(forecasts);
  const size_t num_clusters = static_cast<size_t>(*std::ranges::max_element(clusters)) + 1;
  const size_t K = static_cast<size_t>(num_bins);
  std::vector<double> excess(num_clusters * K),
      sizes(num_clusters);  // sum of probability - outcome; forecasts
  std::vector<ConditionCount> counts(num_clusters);
  for (size_t i = 0; i < forecasts.size(); ++i) {
    const size_t cluster = static_cast<size_t>(clusters[i]);
    excess[cluster * K + bin_numbers[i]] += forecasts[i].probability - (forecasts[i].happened ? 1.0 : 0.0);
    sizes[cluster] += 1.0;
    counts[cluster].num_events += forecasts[i].happened;
    ++counts[cluster].num_trials;
  }
  const ConditionStatistic error = [&](std::span<const int> times) {
    std::vector<double> sums(K);
    double n = 0.0, sum = 0.0;
    for (size_t c = 0; c < num_clusters; ++c) {
      n += times[c] * sizes[c];
      for (size_t k = 0; times[c] > 0 && k < K; ++k) sums[k] += times[c] * excess[c * K + k];
    }
    for (const double of_bin : sums) sum += std::abs(of_bin) / n;
    return sum;
  };
  BootstrapOptions options = given;
  options.chance_bias = ChanceBias::kUpwards;
  BootstrapEstimate estimate = BootstrapOverConditions(num_clusters, error, options, rng);
  WidenForUnseenEvents(forecasts, counts, &estimate);
  return estimate;
}

}  // namespace rcme
