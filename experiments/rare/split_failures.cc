#include "experiments/rare/split_failures.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();

// The pilot has the number 0, replicates count from 1.
RandomStream MakeStream(std::uint64_t seed, const Condition& condition, std::uint32_t number) {
  return RandomStream({seed, condition.stream_key, number, kSplittingPurpose});
}

std::string PilotAsJson(const SplittingPilot& pilot) {
  return Json::array({static_cast<int>(pilot.end), NumbersAsJson(pilot.levels.levels),
                      NumbersAsJson(pilot.levels.steps), NumberAsJson(pilot.last_level), pilot.num_values})
      .dump();
}

bool AreShares(const std::vector<double>& numbers) {
  constexpr double kRounding = 1e-9;  // rounding error of a mean of shares
  return std::ranges::all_of(numbers, [](double x) { return x >= 0.0 && x <= 1.0 + kRounding; });
}

// The number of values of all particles: one at the start, and one per move at each level.
std::int64_t NumValues(const SplittingEffort& effort, size_t num_levels) {
  return effort.num_particles * (1 + static_cast<std::int64_t>(num_levels) * effort.num_moves);
}

SplittingPilot PilotFrom(const Json& json, const SplittingEffort& effort) {
  RequireSize(json, 5);
  const auto last = static_cast<std::int64_t>(PilotEnd::kTooRare);
  const SplittingPilot pilot{static_cast<PilotEnd>(CountFrom(json[0], last)),
                             {NumbersFrom(json[1]), NumbersFrom(json[2])},
                             NumberFrom(json[3]),
                             CountFrom(json[4], kMost)};
  const std::vector<double>& levels = pilot.levels.levels;
  RequirePossible(levels.size() == pilot.levels.steps.size(), "numbers", "levels without steps");
  RequirePossible(std::ranges::is_sorted(levels) && AreShares(pilot.levels.steps), "numbers",
                  "levels that fall");
  RequirePossible(pilot.num_values == NumValues(effort, levels.size()), "numbers",
                  "another number of values");
  return pilot;
}

std::string ReplicateAsJson(const SplittingReplicate& r) {
  return Json::array({NumberAsJson(r.estimate), NumbersAsJson(r.shares), NumbersAsJson(r.acceptance),
                      r.num_drawn, r.num_drawn_events, r.num_ancestors, r.num_values})
      .dump();
}

SplittingReplicate ReplicateFrom(const Json& json, const SplittingEffort& effort) {
  RequireSize(json, 7);
  const std::int64_t num_particles = effort.num_particles;
  const SplittingReplicate replicate{NumberFrom(json[0]),
                                     NumbersFrom(json[1]),
                                     NumbersFrom(json[2]),
                                     CountFrom(json[3], num_particles),
                                     CountFrom(json[4], num_particles),
                                     static_cast<int>(CountFrom(json[5], num_particles)),
                                     CountFrom(json[6], kMost)};
  double product = 1.0;
  for (const double share : replicate.shares) product *= share;
  RequirePossible(AreShares(replicate.shares) && AreShares(replicate.acceptance), "numbers",
                  "a share that is none");
  RequirePossible(replicate.estimate == product, "numbers", "the estimate is not the product of the shares");
  RequirePossible(replicate.num_drawn == num_particles, "numbers", "another number of particles");
  RequirePossible(replicate.num_values == NumValues(effort, replicate.acceptance.size()), "numbers",
                  "another number of values");
  return replicate;
}

// Follows the numbers of the effort; empty for failures.
std::string DescribeEvent(const RareEvent& event) {
  if (event.kind == RareEvent::Kind::kFailure) return "";
  return fmt::format("event: {}, risk {}\n", Name(event.kind), event.risk);
}

// Every estimator in every condition, without results.
std::vector<RareCell> MakeCells(const StudyPlan& plan) {
  std::vector<RareCell> cells;
  for (size_t c = 0; c < plan.conditions.size(); ++c) {
    for (size_t e = 0; e < plan.estimators.size(); ++e) {
      RareCell& cell = cells.emplace_back();
      cell.condition = c;
      cell.estimator = e;
    }
  }
  return cells;
}

}  // namespace

WorkPlan PlanSplitting(const StudyPlan& plan, std::uint64_t seed, const RareEffort& effort) {
  WorkPlan work{
      "splitting",
      "replicate",
      fmt::format("seed: {}\nparticles: {}\nmoves: {}\nkept share: {}\nreplicates: {}\n{}{}", seed,
                  effort.splitting.num_particles, effort.splitting.num_moves, effort.splitting.kept_share,
                  effort.num_replicates, DescribeEvent(effort.event), plan.identity),
      {}};
  for (const auto& [name, num_items] : {std::pair<const char*, int>{"pilot", 1},
                                        std::pair<const char*, int>{"replicates", effort.num_replicates}}) {
    for (const RareCell& cell : MakeCells(plan)) {
      work.groups.push_back({fmt::format("{} of condition {} and estimator {}", name, cell.condition,
                                         plan.study.estimators[cell.estimator].label),
                             static_cast<size_t>(num_items)});
    }
  }
  return work;
}

std::vector<RareCell> SplitFailures(const StudyPlan& plan, std::uint64_t seed, const RareEffort& effort,
                                    Runner* runner) {
  std::vector<RareCell> cells = MakeCells(plan);
  std::vector<FailingMotion> systems;  // made first, so that bad input throws before any work
  for (RareCell& cell : cells) {
    const FailingMotion& system =
        systems.emplace_back(plan, plan.conditions[cell.condition], cell.estimator, effort.event);
    cell.num_not_simulated = system.num_not_simulated();
    if (cell.num_not_simulated < FailingMotion::kNumTried) continue;
    cell.why_not_simulated = system.why_not_simulated();
    cell.pilot.end = PilotEnd::kStuck;
  }
  const WorkPlan& work = runner->plan();
  const size_t num_cells = cells.size();
  std::vector<ItemPlace> pilots = ListItems(work, {}, 0, num_cells);
  std::erase_if(pilots,
                [&](const ItemPlace& place) { return !cells[place.group].why_not_simulated.empty(); });
  runner->Get(pilots, [&](const ItemPlace& place) {
    RandomStream rng = MakeStream(seed, plan.conditions[cells[place.group].condition], 0);
    return PilotAsJson(FindLevels(systems[place.group], effort.splitting, rng));
  });
  ReadResults(work, runner->results(), 0, num_cells, [&](const ItemPlace& place, const std::string& json) {
    cells[place.group].pilot = PilotFrom(ParsePiece(json), effort.splitting);
  });
  std::vector<ItemPlace> replicates = ListItems(work, {}, num_cells, 2 * num_cells);
  std::erase_if(replicates, [&](const ItemPlace& place) {
    return cells[place.group - num_cells].pilot.end != PilotEnd::kReached;
  });
  runner->Get(replicates, [&](const ItemPlace& place) {
    const size_t c = place.group - num_cells;
    RandomStream rng =
        MakeStream(seed, plan.conditions[cells[c].condition], 1 + static_cast<std::uint32_t>(place.item));
    return ReplicateAsJson(Split(systems[c], effort.splitting, cells[c].pilot.levels, rng));
  });
  ReadResults(work, runner->results(), num_cells, 2 * num_cells,
              [&](const ItemPlace& place, const std::string& json) {
                cells[place.group - num_cells].replicates.push_back(
                    ReplicateFrom(ParsePiece(json), effort.splitting));
              });
  for (RareCell& cell : cells) cell.rate = EstimateSplittingRate(cell.pilot, cell.replicates);
  return cells;
}

}  // namespace rcme
