#include "experiments/integrity/integrity_counts.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <stdexcept>

#include "estimator/protection_level.h"
#include "experiments/core/text/pick_name.h"
#include "experiments/core/work/part_file.h"
#include "experiments/trial/truth_error.h"
#include "stats/constants.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

std::int64_t CountIn(const RegionCounts& counts, StanfordRegion region) {
  return counts[static_cast<size_t>(region)];
}

using Either = IntegrityTally::Either;

Json EitherAsJson(const Either& either) {
  return Json{either.num_answers, either.num_available, either.num_misleading, either.num_hazardous};
}

Either EitherFrom(const Json& json, const IntegrityTally& tally) {
  RequireSize(json, 4);
  Either either;
  either.num_answers = CountFrom(json[0], std::min(tally.NumAnswers(0), tally.NumAnswers(1)));
  either.num_available = CountFrom(json[1], either.num_answers);
  either.num_misleading = CountFrom(json[2], either.num_answers);
  either.num_hazardous = CountFrom(json[3], either.num_misleading);
  return either;
}

Json TallyAsJson(const IntegrityTally& tally) {
  return Json{tally.num_without_motion, tally.regions[0], tally.regions[1], EitherAsJson(tally.either)};
}

IntegrityTally TallyFrom(const Json& json, std::int64_t most) {
  RequireSize(json, 2 + kNumIntegrityQuantities);
  IntegrityTally tally;
  tally.num_without_motion = CountFrom(json[0], most);
  for (size_t q = 0; q < kNumIntegrityQuantities; ++q) {
    RequireSize(json[1 + q], kNumStanfordRegions);
    for (size_t r = 0; r < kNumStanfordRegions; ++r) tally.regions[q][r] = CountFrom(json[1 + q][r], most);
    if (tally.NumTrials(q) > most) throw std::invalid_argument("more outcomes than trials");
  }
  tally.either = EitherFrom(json[1 + kNumIntegrityQuantities], tally);
  return tally;
}

// For each quantity: [answers with inexact truth, misleading least, most, hazardous least, most].
Json SensitivityAsJson(const TruthSensitivity& sensitivity) {
  Json json = Json::array();
  for (size_t q = 0; q < kNumIntegrityQuantities; ++q)
    json.push_back({sensitivity.num_inexact[q], sensitivity.misleading[q].least,
                    sensitivity.misleading[q].most, sensitivity.hazardous[q].least,
                    sensitivity.hazardous[q].most});
  return json;
}

TruthSensitivity SensitivityFrom(const Json& json, const IntegrityTally& tally) {
  RequireSize(json, kNumIntegrityQuantities);
  TruthSensitivity sensitivity;
  const auto range_from = [](const Json& least, const Json& most, std::int64_t num_answers) {
    TruthSensitivity::Range range;
    range.most = CountFrom(most, num_answers);
    range.least = CountFrom(least, range.most);
    return range;
  };
  for (size_t q = 0; q < kNumIntegrityQuantities; ++q) {
    RequireSize(json[q], 5);
    const std::int64_t num_answers = tally.NumAnswers(q);
    sensitivity.num_inexact[q] = CountFrom(json[q][0], num_answers);
    sensitivity.misleading[q] = range_from(json[q][1], json[q][2], num_answers);
    sensitivity.hazardous[q] = range_from(json[q][3], json[q][4], num_answers);
  }
  return sensitivity;
}

// [cell, count, cell, count, ...]
Json CellsAsJson(const std::map<int, std::int64_t>& cells) {
  Json json = Json::array();
  for (const auto& [cell, count] : cells) {
    json.push_back(cell);
    json.push_back(count);
  }
  return json;
}

std::map<int, std::int64_t> CellsFrom(const Json& json, std::int64_t num_answers) {
  constexpr size_t kNumCells = size_t{kNumIntegrityBins} * kNumIntegrityBins;
  if (!json.is_array() || json.size() % 2 != 0 || json.size() > 2 * kNumCells)
    throw std::invalid_argument("it is no list of cells with their counts");
  std::map<int, std::int64_t> cells;
  std::int64_t sum = 0;
  for (size_t i = 0; i < json.size(); i += 2) {
    const std::int64_t count = CountFrom(json[i + 1], num_answers);
    cells[static_cast<int>(CountFrom(json[i], kNumCells - 1))] += count;
    sum += count;
  }
  if (sum != num_answers) throw std::invalid_argument("the cells have another number of answers");
  return cells;
}

}  // namespace

const char* IntegrityQuantityName(size_t quantity) {
  return quantity == 0 ? "rotation" : quantity == 1 ? "direction" : "either";
}

const char* Name(StanfordRegion region) {
  return PickName(region, {"available", "misleading", "hazardous", "unavailable", "unavailable_misleading"});
}

StanfordRegion FindStanfordRegion(double error, double level, double limit) {
  const bool is_misleading = !(error <= level);
  if (level > limit)
    return is_misleading ? StanfordRegion::kUnavailableMisleading : StanfordRegion::kUnavailable;
  if (!is_misleading) return StanfordRegion::kAvailable;
  return error > limit ? StanfordRegion::kHazardous : StanfordRegion::kMisleading;
}

void IntegrityTally::Add(const IntegrityTally& other) {
  num_without_motion += other.num_without_motion;
  for (size_t q = 0; q < kNumIntegrityQuantities; ++q) {
    for (size_t r = 0; r < kNumStanfordRegions; ++r) regions[q][r] += other.regions[q][r];
  }
  either.num_answers += other.either.num_answers;
  either.num_available += other.either.num_available;
  either.num_misleading += other.either.num_misleading;
  either.num_hazardous += other.either.num_hazardous;
}

void TruthSensitivity::Add(const TruthSensitivity& other) {
  const auto add = [](Range* range, const Range& more) {
    range->least += more.least;
    range->most += more.most;
  };
  for (size_t q = 0; q < kNumIntegrityQuantities; ++q) {
    num_inexact[q] += other.num_inexact[q];
    add(&misleading[q], other.misleading[q]);
    add(&hazardous[q], other.hazardous[q]);
  }
}

std::int64_t IntegrityTally::NumAnswers(size_t quantity) const {
  if (quantity == kEither) return either.num_answers;
  return std::accumulate(regions[quantity].begin(), regions[quantity].end(), std::int64_t{0});
}

std::int64_t IntegrityTally::NumAvailable(size_t quantity) const {
  if (quantity == kEither) return either.num_available;
  const RegionCounts& of = regions[quantity];
  return CountIn(of, StanfordRegion::kAvailable) + CountIn(of, StanfordRegion::kMisleading) +
         CountIn(of, StanfordRegion::kHazardous);
}

std::int64_t IntegrityTally::NumMisleading(size_t quantity) const {
  if (quantity == kEither) return either.num_misleading;
  const RegionCounts& of = regions[quantity];
  return CountIn(of, StanfordRegion::kMisleading) + CountIn(of, StanfordRegion::kHazardous) +
         CountIn(of, StanfordRegion::kUnavailableMisleading);
}

std::int64_t IntegrityTally::NumHazardous(size_t quantity) const {
  if (quantity == kEither) return either.num_hazardous;
  return CountIn(regions[quantity], StanfordRegion::kHazardous);
}

double IntegrityEdgeDeg(int k) {
  return 180.0 * std::pow(10.0, static_cast<double>(k - kNumIntegrityBins) / kIntegrityBinsPerDecade);
}

int FindIntegrityBin(double angle_deg) {
  const double place = kNumIntegrityBins + kIntegrityBinsPerDecade * std::log10(angle_deg / 180.0);
  return static_cast<int>(std::clamp(std::ceil(place) - 1.0, 0.0, kNumIntegrityBins - 1.0));
}

void IntegrityCounts::Add(const IntegrityCounts& other) {
  tally.Add(other.tally);
  truth_sensitivity.Add(other.truth_sensitivity);
  num_refusals += other.num_refusals;
  num_invalid += other.num_invalid;
  num_not_simulated += other.num_not_simulated;
  for (size_t q = 0; q < kNumIntegrityQuantities; ++q) {
    num_unscored[q] += other.num_unscored[q];
    for (const auto& [cell, count] : other.cells[q]) cells[q][cell] += count;
  }
}

namespace {

bool IsMisleading(StanfordRegion region) {
  return region == StanfordRegion::kMisleading || region == StanfordRegion::kHazardous ||
         region == StanfordRegion::kUnavailableMisleading;
}

bool IsAvailable(StanfordRegion region) {
  return region != StanfordRegion::kUnavailable && region != StanfordRegion::kUnavailableMisleading;
}

Either CountEither(const std::array<StanfordRegion, kNumIntegrityQuantities>& regions) {
  Either either{1, 1, 0, 0};
  for (const StanfordRegion region : regions) {
    if (!IsAvailable(region)) either.num_available = 0;
    if (IsMisleading(region)) either.num_misleading = 1;
    if (region == StanfordRegion::kHazardous) either.num_hazardous = 1;
  }
  return either;
}

void AddTruthSensitivity(double error_deg, double level_deg, double limit_deg, double truth_error_deg,
                         size_t quantity, TruthSensitivity* sensitivity) {
  const StanfordRegion nearest = FindStanfordRegion(std::max(error_deg - truth_error_deg, 0.0), level_deg,
                                                    limit_deg),
                       farthest = FindStanfordRegion(error_deg + truth_error_deg, level_deg, limit_deg);
  sensitivity->num_inexact[quantity] += truth_error_deg > 0.0;
  sensitivity->misleading[quantity].least += IsMisleading(nearest);
  sensitivity->misleading[quantity].most += IsMisleading(farthest);
  sensitivity->hazardous[quantity].least += nearest == StanfordRegion::kHazardous;
  sensitivity->hazardous[quantity].most += farthest == StanfordRegion::kHazardous;
}

}  // namespace

IntegrityCounts CountTrial(const TrialResult& result, const IntegrityTerms& terms) {
  IntegrityCounts counts;
  const TrialRecord& record = result.records.front();
  counts.num_not_simulated = !WasSimulated(record);
  counts.num_refusals = HasRefused(record);
  counts.num_invalid = IsInvalid(record);
  counts.tally.num_without_motion = counts.num_refusals + counts.num_invalid;
  if (record.status == MotionStatus::kTruthInDoubt) counts.num_unscored.fill(1);
  if (record.status != MotionStatus::kOk) return counts;
  const ProtectionLevels levels = ComputeProtectionLevels(result.estimates.front(), terms.risk);
  const std::array<double, kNumIntegrityQuantities> errors_deg = {record.rotation_error_deg,
                                                                  record.direction_error_deg};
  const std::array<double, kNumIntegrityQuantities> levels_deg = {kDegPerRad * levels.rotation_rad,
                                                                  kDegPerRad * levels.direction_rad};
  const TruthErrorDeg truth_error = ComputeTruthErrorDeg(result.data.truth);
  const std::array<double, kNumIntegrityQuantities> truth_errors_deg = {truth_error.rotation,
                                                                        truth_error.direction};
  std::array<StanfordRegion, kNumIntegrityQuantities> regions{};
  for (size_t q = 0; q < kNumIntegrityQuantities; ++q) {
    if (std::isnan(errors_deg[q])) {
      counts.num_unscored[q] = 1;
      continue;
    }
    regions[q] = FindStanfordRegion(errors_deg[q], levels_deg[q], terms.LimitDeg(q));
    AddTruthSensitivity(errors_deg[q], levels_deg[q], terms.LimitDeg(q), truth_errors_deg[q], q,
                        &counts.truth_sensitivity);
    counts.tally.regions[q][static_cast<size_t>(regions[q])] = 1;
    counts.cells[q][FindIntegrityBin(errors_deg[q]) * kNumIntegrityBins + FindIntegrityBin(levels_deg[q])] =
        1;
  }
  if (counts.num_unscored[0] == 0 && counts.num_unscored[1] == 0) counts.tally.either = CountEither(regions);
  return counts;
}

std::string IntegrityCountsAsText(const IntegrityCounts& counts,
                                  const std::map<std::int64_t, IntegrityTally>& scenes) {
  Json of_scenes = Json::array();
  for (const auto& [scene, tally] : scenes) of_scenes.push_back(Json{scene, TallyAsJson(tally)});
  return Json{TallyAsJson(counts.tally),    counts.num_invalid,
              counts.num_not_simulated,     counts.num_unscored,
              CellsAsJson(counts.cells[0]), CellsAsJson(counts.cells[1]),
              std::move(of_scenes),         SensitivityAsJson(counts.truth_sensitivity)}
      .dump();
}

IntegrityCounts ReadIntegrityCounts(const std::string& text, std::int64_t most,
                                    std::map<std::int64_t, IntegrityTally>* scenes) {
  const Json json = ParsePiece(text);
  RequireSize(json, 8);
  IntegrityCounts counts;
  counts.tally = TallyFrom(json[0], most);
  counts.num_invalid = CountFrom(json[1], counts.tally.num_without_motion);
  counts.num_refusals = counts.tally.num_without_motion - counts.num_invalid;
  counts.num_not_simulated = CountFrom(json[2], most);
  RequireSize(json[3], kNumIntegrityQuantities);
  for (size_t q = 0; q < kNumIntegrityQuantities; ++q) {
    counts.num_unscored[q] = CountFrom(json[3][q], most);
    if (counts.tally.NumTrials(q) + counts.num_unscored[q] + counts.num_not_simulated != most)
      throw std::invalid_argument("the outcomes are not as many as the trials");
    counts.cells[q] = CellsFrom(json[4 + q], counts.tally.NumAnswers(q));
  }
  counts.truth_sensitivity = SensitivityFrom(json[7], counts.tally);
  if (!json[6].is_array()) throw std::invalid_argument("it is no list of scenes");
  for (const Json& scene : json[6]) {
    RequireSize(scene, 2);
    (*scenes)[CountFrom(scene[0], std::numeric_limits<std::int32_t>::max())].Add(TallyFrom(scene[1], most));
  }
  return counts;
}

}  // namespace rcme
