#include "experiments/real/truth_free/twin_report.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "experiments/data/make_data.h"
#include "experiments/real/truth_free/noise_fit.h"
#include "experiments/real/truth_free/twin_quantities.h"
#include "experiments/real/truth_free/twin_settings.h"
#include "parameters/input_error.h"
#include "stats/constants.h"
#include "stats/fnv1a.h"
#include "stats/shared_members.h"

namespace rcme {
namespace {

constexpr std::int64_t kLeastPairs = 3;  // for a mean to be compared

double ComputeMean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double x : values) sum += x;
  return sum / static_cast<double>(values.size());
}

// A pair of a scene: numbers of its images, its values and those of its twins.
struct ComparedPair {
  std::int64_t image1 = 0, image2 = 0;
  Values observed, twins;
};

std::vector<PairEvent> ListPairEvents(const std::vector<ComparedPair>& pairs, size_t quantity) {
  std::vector<PairEvent> events;
  for (const ComparedPair& pair : pairs) {
    for (const double x : pair.observed[quantity]) events.push_back({pair.image1, pair.image2, x != 0.0});
  }
  return events;
}

// For a mean: observed minus predicted values. The prediction is that for the same pair, or for all pairs if
// the twins do not belong to pairs.
std::vector<PairValue> ListPairDifferences(const std::vector<ComparedPair>& pairs, size_t quantity,
                                           bool is_paired, double prediction) {
  std::vector<PairValue> differences;
  for (const ComparedPair& pair : pairs) {
    const std::vector<double>& twins = pair.twins[quantity];
    if (pair.observed[quantity].empty() || (is_paired && twins.empty())) continue;
    const double predicted = is_paired ? ComputeMean(twins) : prediction;
    differences.push_back({pair.image1, pair.image2, ComputeMean(pair.observed[quantity]) - predicted});
  }
  return differences;
}

// The mean over twins; for paired twins the mean over pairs that have a value themselves.
double ComputePrediction(const std::vector<ComparedPair>& pairs, size_t quantity, bool is_paired_mean) {
  std::vector<double> all;
  for (const ComparedPair& pair : pairs) {
    const std::vector<double>& twins = pair.twins[quantity];
    if (!is_paired_mean)
      all.insert(all.end(), twins.begin(), twins.end());
    else if (!twins.empty() && !pair.observed[quantity].empty())
      all.push_back(ComputeMean(twins));
  }
  return all.empty() ? kNaN : ComputeMean(all);
}

double CountTwinEvents(const std::vector<ComparedPair>& pairs, size_t quantity) {
  size_t count = 0;
  for (const ComparedPair& pair : pairs) count += pair.twins[quantity].size();
  return static_cast<double>(count);
}

std::optional<TwinComparison> Compared(const std::vector<ComparedPair>& pairs, size_t quantity,
                                       const std::string& twin, double confidence) {
  const QuantityText& text = kQuantityTexts[quantity];
  const bool is_paired = twin == "semi_real" && !text.is_rate;
  TwinComparison compared;
  compared.quantity = text.name;
  compared.twin = twin;
  compared.is_rate = text.is_rate;
  // Points of a simulated scene are not found twice.
  compared.is_fitted = text.is_fitted && !(twin == "simulated" && quantity == kNearCorrelation);
  compared.predicted = ComputePrediction(pairs, quantity, is_paired);
  if (std::isnan(compared.predicted)) return std::nullopt;
  if (text.is_rate) {
    const SharedMemberRate rate = MeasureSharedMemberRate(ListPairEvents(pairs, quantity), confidence);
    if (rate.n == 0) return std::nullopt;
    compared.n = rate.n;
    compared.observed = rate.rate;
    compared.joint = rate.interval;
    compared.half_event = 0.5 / CountTwinEvents(pairs, quantity);
    return compared;
  }
  const SharedMemberMean mean = MeasureSharedMemberMean(
      ListPairDifferences(pairs, quantity, is_paired, compared.predicted), confidence);
  if (mean.n < kLeastPairs) return std::nullopt;
  compared.n = mean.n;
  compared.observed = compared.predicted + mean.value;
  compared.joint = {compared.predicted + mean.interval.lower, compared.predicted + mean.interval.upper};
  if (quantity == kRotationSd || quantity == kDirectionSd) {
    for (double* x : {&compared.observed, &compared.predicted, &compared.joint.lower, &compared.joint.upper})
      *x = std::exp(*x);
  }
  return compared;
}

void AddComparisons(const std::vector<ComparedPair>& pairs, const std::string& twin, TwinReport* report) {
  size_t num_compared = 0;
  for (size_t q = 0; q < kNumQuantities; ++q) num_compared += Compared(pairs, q, twin, 0.95).has_value();
  const double confidence = 1.0 - 0.05 / static_cast<double>(std::max<size_t>(num_compared, 1));
  for (size_t q = 0; q < kNumQuantities; ++q) {
    const std::optional<TwinComparison> compared = Compared(pairs, q, twin, confidence);
    if (compared) report->comparisons.push_back(*compared);
  }
}

Values Joined(Values a, const Values& b) {
  for (size_t q = 0; q < kNumQuantities; ++q) a[q].insert(a[q].end(), b[q].begin(), b[q].end());
  return a;
}

constexpr std::uint32_t kCallsOfOne = 8;  // numbers of trials: a pair's own calls, then those of each twin

std::string ValuesAsJson(const Values& values) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const std::vector<double>& of_quantity : values) json.push_back(NumbersAsJson(of_quantity));
  return json.dump();
}

Values ValuesFrom(const std::string& text) {
  const nlohmann::ordered_json json = ParsePiece(text);
  RequireSize(json, kNumQuantities);
  Values values;
  for (size_t q = 0; q < kNumQuantities; ++q) {
    values[q] = NumbersFrom(json[q]);
    const auto is_event = [](double x) { return x == 0.0 || x == 1.0; };
    if (kQuantityTexts[q].is_rate && !std::ranges::all_of(values[q], is_event))
      throw std::invalid_argument("an event that neither is nor is not");
  }
  return values;
}

Values TakeValues(const std::function<Values()>& compute, KeptSteps* steps) {
  return TakeStep<Values>(steps, compute, {ValuesAsJson, ValuesFrom});
}

Values TakeTwin(const std::function<TrialData()>& make, const MotionEstimator& estimator,
                const StreamName& name, KeptSteps* steps) {
  const auto compute = [&] {
    const TrialData twin = make();
    return ComputeValues(twin, AnswerTo(twin.problem, estimator, name), estimator, name);
  };
  return TakeValues(compute, steps);
}

std::vector<ComparedPair> ObservePairs(const TwinSource& source, const MotionEstimator& estimator,
                                       std::uint64_t seed, KeptSteps* steps) {
  std::map<std::string, std::int64_t> numbers;
  const auto number_of = [&](const std::string& image, const std::string& otherwise) {
    const std::string& name = image.empty() ? otherwise : image;
    return numbers.try_emplace(name, static_cast<std::int64_t>(numbers.size())).first->second;
  };
  std::vector<ComparedPair> pairs;
  for (const AnsweredTrial& one : source.pairs) {
    const StreamName name{seed, HashToStreamKey(one.pair.origin), 0, 0};
    const std::int64_t image1 = number_of(one.image1, one.pair.origin + "/1"),
                       image2 = number_of(one.image2, one.pair.origin + "/2");
    const Values observed =
        TakeValues([&] { return ComputeValues(one.pair, one.estimate, estimator, name); }, steps);
    pairs.push_back({image1, image2, observed, {}});
  }
  return pairs;
}

}  // namespace

int TwinReport::NumCompared(const std::string& twin, bool fitted) const {
  return static_cast<int>(std::ranges::count_if(
      comparisons, [&](const TwinComparison& c) { return c.twin == twin && c.is_fitted == fitted; }));
}

int TwinReport::NumWithin(const std::string& twin, bool fitted) const {
  return static_cast<int>(std::ranges::count_if(comparisons, [&](const TwinComparison& c) {
    return c.twin == twin && c.is_fitted == fitted && c.IsWithin();
  }));
}

TwinReport MakeTwinReport(const TwinSource& source, const MotionEstimator& estimator,
                          const std::string& folder, double assumed_sigma_px, std::uint64_t seed,
                          int num_twins, KeptSteps* steps) {
  TwinReport report;
  report.scene = source.scene;
  report.num_pairs = static_cast<int>(source.pairs.size());
  report.fit = FitTwin(source, estimator, seed, steps);
  report.semi_real = SemiRealData(report.fit, folder, assumed_sigma_px);
  std::vector<ComparedPair> pairs = ObservePairs(source, estimator, seed, steps);
  const Redraw redraw(report.fit.noise);
  for (size_t i = 0; i < pairs.size(); ++i) {
    if (!source.pairs[i].exact) continue;
    for (int k = 1; k <= num_twins; ++k) {
      const AnsweredTrial& of = source.pairs[i];
      const StreamName name{seed, HashToStreamKey(of.pair.origin),
                            static_cast<std::uint32_t>(k) * kCallsOfOne, 0};
      const auto make = [&] { return redraw.Draw(*of.exact, name, of.noise_level); };
      pairs[i].twins = Joined(pairs[i].twins, TakeTwin(make, estimator, name, steps));
    }
  }
  AddComparisons(pairs, "semi_real", &report);
  try {
    const double clustered_share = FitClusteredShare(report.fit);
    report.fit.simulated_noise =
        FitSimulatedNoise(source, report.fit, clustered_share, estimator, assumed_sigma_px, seed, steps);
    report.simulated = SimulatedTwinData(report.fit, clustered_share, assumed_sigma_px);
    const std::shared_ptr<const SimulatedData> data = MakeSimulatedData(report.simulated);
    for (size_t i = 0; i < pairs.size(); ++i) {
      pairs[i].twins = Values();
      for (int k = 1; k <= num_twins; ++k) {
        const StreamName name{
            seed, HashToStreamKey(source.scene),
            (static_cast<std::uint32_t>(i) * 1000 + static_cast<std::uint32_t>(k)) * kCallsOfOne, 0};
        const auto make = [&] { return data->Make(name); };
        pairs[i].twins = Joined(pairs[i].twins, TakeTwin(make, estimator, name, steps));
      }
    }
    AddComparisons(pairs, "simulated", &report);
  } catch (const KeptResultsError&) {
    throw;
  } catch (const InputError& error) {
    report.simulated.clear();
    report.why_not_simulated = error.what();
  }
  return report;
}

}  // namespace rcme
