#include "experiments/statistics/surface_data.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "experiments/core/text/json_output.h"
#include "experiments/run/store/result_store.h"
#include "experiments/study/estimator_spec.h"
#include "experiments/study/population.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

// The draw itself is not a factor of the surface.
Json LevelsAsJson(const std::vector<std::string>& factors, const std::vector<std::string>& levels) {
  Json json = Json::array();
  for (size_t f = 0; f < factors.size(); ++f)
    if (factors[f] != kDrawFactor) json.push_back(levels[f]);
  return json;
}

// Describes a factor: its range in the population. A key with several ranges gets the widest.
Json FactorAsJson(const std::string& name, const std::optional<Population>& population) {
  Json factor = {{"name", name}, {"scale", nullptr}};
  double low = std::numeric_limits<double>::infinity(), high = -low;
  if (!population) return factor;
  for (const DrawnKey& drawn : population->keys) {
    if (drawn.key != name) continue;
    if (drawn.range.kind == DrawnRange::Kind::kAnyOf) return {{"name", name}, {"scale", nullptr}};
    low = std::min(low, drawn.range.from), high = std::max(high, drawn.range.to);
    factor["scale"] = drawn.range.kind == DrawnRange::Kind::kLogUniform ? "log" : "linear";
    factor["low"] = low, factor["high"] = high;
  }
  return factor;
}

Json FactorsAsJson(const RunDescription& run, const Study& study) {
  Json factors = Json::array();
  for (const std::string& name : run.factors)
    if (name != kDrawFactor) factors.push_back(FactorAsJson(name, study.population));
  return factors;
}

std::string NameOfQuantity(MarginalQuantity quantity) {
  return quantity == MarginalQuantity::kFailedLessStated ? "P-y" : Name(quantity);
}

// Returns n, mean and standard deviation of the quantity in each condition of a run; for a coverage also the
// sharpness.
Json RenderConditionMoments(const ResultStore& store, const RunDescription& run, size_t number,
                            size_t estimator, MarginalQuantity quantity) {
  Json conditions = Json::array();
  const auto values = CollectConditionMoments(store, estimator, quantity);
  const double sign = quantity == MarginalQuantity::kFailedLessStated ? -1.0 : 1.0;  // P - y, not failed - P
  for (size_t c = 0; c < run.conditions.size(); ++c) {
    const auto& [moments, log_sd_over_crb] = values[c];
    const std::vector<std::string>& levels = run.conditions[c].levels;
    const auto draw = FindDraw(run.factors, levels);
    conditions.push_back({{"run", number},
                          {"condition", c},
                          {"draw", draw ? Json(*draw) : Json()},
                          {"levels", LevelsAsJson(run.factors, levels)},
                          {"n", moments.n()},
                          {"mean", moments.n() > 0 ? Json(sign * moments.mean()) : Json()},
                          {"sd", moments.n() > 1 ? Json(std::sqrt(moments.variance())) : Json()}});
    if (log_sd_over_crb.n() > 0) conditions.back()["sd_over_crb"] = std::exp(log_sd_over_crb.mean());
  }
  return conditions;
}

// Returns the number of the last draw plus one; 0 without a population.
int CountDrawn(const Study& study) {
  if (!study.population) return 0;
  const Population& population = *study.population;
  return population.draws.empty() ? population.number : population.draws.back() + 1;
}

// Returns draws with numbers from `first` on that meet the study's restrictions, with every combination of
// the levels of its factors.
Json CandidatesAsJson(Study study, int first, int number) {
  if (!study.population)
    throw InputError("--propose: the study of this run has no population to draw further conditions from");
  if (study.population->design == PointSet::kLatinHypercube)
    throw InputError(
        "--propose: further draws of a latin_hypercube are not those of its first part; use design sobol or "
        "random");
  study.population->draws.clear();
  study.population->number = std::min(first + number, kMaxDraws);
  const std::vector<std::string> factors = FactorNames(study);
  Json candidates = Json::array();
  for (const PopulationDraw& draw : DrawPopulation(study)) {
    if (draw.number < first || !draw.outside_of.empty()) continue;
    for (const std::vector<std::string>& row : FactorRows(study))
      candidates.push_back({{"draw", draw.number}, {"levels", LevelsAsJson(factors, JoinLevels(draw, row))}});
  }
  return candidates;
}

void RequireSameFactors(const RunDescription& first, const RunDescription& run, const std::string& path) {
  if (run.factors != first.factors)
    throw InputError(
        fmt::format("{}: has other factors than the first run: {}", path, fmt::join(run.factors, ", ")));
}

}  // namespace

std::string SurfaceDataAsJson(const std::vector<std::string>& runs, const SurfaceOptions& options) {
  std::optional<RunDescription> first;
  std::optional<Study> study;
  Json files = Json::array(), conditions = Json::array();
  std::string estimator = options.estimator;
  int num_drawn = 0;  // no run has a later draw
  for (size_t i = 0; i < runs.size(); ++i) {
    const ResultStore store = ResultStore::OpenForReading(runs[i]);
    const RunDescription run = store.Description();
    const Study stored = store.StoredStudy();
    if (!first) first = run, study = stored;
    RequireSameFactors(*first, run, runs[i]);
    num_drawn = std::max(num_drawn, CountDrawn(stored));
    const size_t e =
        estimator.empty() ? 0 : FindEstimator(run.estimators, estimator, "--estimator: " + runs[i]);
    estimator = run.estimators[e].label;
    files.push_back(
        {{"path", runs[i]}, {"study", run.study}, {"is_sample", IsSampleOfPopulation(run.identity)}});
    for (Json& condition : RenderConditionMoments(store, run, i, e, options.quantity))
      conditions.push_back(std::move(condition));
  }
  Json candidates = Json::array();
  if (options.num_candidates > 0) candidates = CandidatesAsJson(*study, num_drawn, options.num_candidates);
  return JsonText(kSurfaceDataFormat, {{"study", first->study},
                                       {"study_yaml", first->study_yaml},
                                       {"estimator", estimator},
                                       {"quantity", NameOfQuantity(options.quantity)},
                                       {"runs", files},
                                       {"factors", FactorsAsJson(*first, *study)},
                                       {"conditions", conditions},
                                       {"candidates", candidates}});
}

}  // namespace rcme
