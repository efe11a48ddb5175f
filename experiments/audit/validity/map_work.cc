#include "experiments/audit/validity/map_work.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t kTrialsOfItem = 100;

constexpr std::array<double ValidityTrial::*, 7> kNumbers = {
    &ValidityTrial::f_nees,       &ValidityTrial::pose_nees,          &ValidityTrial::fresh_point_d2,
    &ValidityTrial::ml_pose_nees, &ValidityTrial::exact_conditioning, &ValidityTrial::observed_conditioning,
    &ValidityTrial::parallax_rad};

size_t NumMapCells(const MapWork& work) { return static_cast<size_t>(NumCells(work.map)); }

TrialRange FindTrialsOfItem(const MapWork& work, const ItemPlace& place) {
  const auto first = static_cast<std::uint32_t>(place.item) * kTrialsOfItem;
  return {first, std::min(first + kTrialsOfItem, static_cast<std::uint32_t>(work.map.trials))};
}

std::string TrialsAsJson(const std::vector<ValidityTrial>& trials) {
  Json json = Json::array();
  for (const ValidityTrial& trial : trials) {
    Json& numbers = json.emplace_back(Json::array());
    for (const auto number : kNumbers) numbers.push_back(NumberAsJson(trial.*number));
  }
  return json.dump();
}

// Values that no trial can have given are damage, even if the checksums are right.
void RequirePossibleTrial(const ValidityTrial& trial) {
  for (const auto share : {&ValidityTrial::exact_conditioning, &ValidityTrial::observed_conditioning}) {
    if (!(trial.*share >= 0.0 && trial.*share <= 1.0))
      throw std::invalid_argument(fmt::format("a conditioning of {}, not of 0 to 1", trial.*share));
  }
  if (!(trial.parallax_rad >= 0.0 && trial.parallax_rad <= std::numbers::pi))
    throw std::invalid_argument(fmt::format("a parallax of {} rad, not of 0 to pi", trial.parallax_rad));
}

void AddTrials(const Json& json, size_t most, std::vector<ValidityTrial>* trials) {
  if (!json.is_array() || json.size() > most)
    throw std::invalid_argument(fmt::format("it is no list of up to {} trials", most));
  for (const Json& numbers : json) {
    RequireSize(numbers, kNumbers.size());
    ValidityTrial& trial = trials->emplace_back();
    for (size_t i = 0; i < kNumbers.size(); ++i) trial.*kNumbers[i] = NumberFrom(numbers[i]);
    RequirePossibleTrial(trial);
  }
}

void AddCovered(const Json& json, std::int64_t most, CoveredCounts* sum) {
  RequireSize(json, sum->size());
  for (size_t q = 0; q < sum->size(); ++q) {
    RequireSize(json[q], (*sum)[q].size());
    for (size_t c = 0; c < (*sum)[q].size(); ++c) (*sum)[q][c] += CountFrom(json[q][c], most);
  }
}

std::string ComputeMapItem(const MapWork& work, const ItemPlace& place) {
  const size_t num_cells = NumMapCells(work);
  if (place.group < num_cells) {
    return TrialsAsJson(
        RunTrialsOfCell(work.map, static_cast<std::uint32_t>(place.group), FindTrialsOfItem(work, place)));
  }
  const auto sample = static_cast<std::uint32_t>(place.item);
  return Json(CountCovered(work.reference.value(), static_cast<std::uint32_t>(place.group - num_cells),
                           sample))
      .dump();
}

// Everything on which the results depend, one line each.
std::string Identity(const MapWork& work) {
  std::string identity = fmt::format("seed: {}\ntrials: {}\n", work.map.seed, work.map.trials);
  if (work.reference) {
    identity += fmt::format("reference: {} m, {} draws, {} noises\n", work.reference->baseline_m,
                            work.reference->num_draws, work.reference->num_noises);
  }
  return identity + (work.identity.empty() ? "the built-in scene\n" : work.identity);
}

}  // namespace

WorkPlan PlanMapWork(const MapWork& work) {
  WorkPlan plan{"map", "block", Identity(work), {}};
  const auto num_blocks = (static_cast<size_t>(work.map.trials) + kTrialsOfItem - 1) / kTrialsOfItem;
  for (std::uint32_t cell = 0; cell < NumMapCells(work); ++cell)
    plan.groups.push_back({DescribeCell(work.map, cell), num_blocks});
  if (!work.reference) return plan;
  for (std::int64_t cell = 0; cell < NumCells(*work.reference); ++cell) {
    plan.groups.push_back(
        {fmt::format("reference cell {}", cell), static_cast<size_t>(work.reference->num_samples)});
  }
  return plan;
}

void GetMapResults(const MapWork& work, Runner* runner) {
  runner->Get(ListItems(runner->plan(), runner->shard()),
              [&](const ItemPlace& place) { return ComputeMapItem(work, place); });
}

TrialsOfCell TrialsIn(const MapWork& work, const WorkPlan& plan, const WorkResults& results) {
  return [&](std::uint32_t cell) {
    std::vector<ValidityTrial> trials;
    ReadResults(plan, results, cell, cell + 1, [&](const ItemPlace& place, const std::string& json) {
      const TrialRange range = FindTrialsOfItem(work, place);
      AddTrials(ParsePiece(json), range.end - range.first, &trials);
    });
    return trials;
  };
}

CountsOfCell CountsIn(const MapWork& work, const WorkPlan& plan, const WorkResults& results) {
  return [&](std::uint32_t cell) {
    CoveredCounts sum{};
    const size_t group = NumMapCells(work) + cell;
    ReadResults(plan, results, group, group + 1, [&](const ItemPlace&, const std::string& json) {
      AddCovered(ParsePiece(json), work.reference->num_draws, &sum);
    });
    return sum;
  };
}

}  // namespace rcme
