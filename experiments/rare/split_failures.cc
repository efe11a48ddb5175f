#include "experiments/rare/split_failures.h"

#include "experiments/core/work/for_each_index.h"

namespace rcme {
namespace {

// The pilot has the number 0, replicates count from 1.
RandomStream StreamOf(std::uint64_t seed, const Condition& condition, std::uint32_t number) {
  return RandomStream({seed, condition.stream_key, number, kSplittingPurpose});
}

}  // namespace

std::vector<RareCell> SplitFailures(const StudyPlan& plan, std::uint64_t seed, const RareEffort& effort,
                                    int num_threads, Progress* progress) {
  std::vector<RareCell> cells;
  std::vector<FailingMotion> systems;  // all made first: bad input ends it before any work
  for (size_t c = 0; c < plan.conditions.size(); ++c) {
    for (size_t e = 0; e < plan.estimators.size(); ++e) {
      RareCell& cell = cells.emplace_back();
      cell.condition = c;
      cell.estimator = e;
      systems.emplace_back(plan, plan.conditions[c], e);
    }
  }
  ForEachIndex(std::ssize(cells), num_threads, [&](std::int64_t index) {
    RareCell& cell = cells[static_cast<size_t>(index)];
    RandomStream rng = StreamOf(seed, plan.conditions[cell.condition], 0);
    cell.pilot = FindLevels(systems[static_cast<size_t>(index)], effort.splitting, rng);
    if (cell.pilot.end == PilotEnd::kReached)
      cell.replicates.resize(static_cast<size_t>(effort.num_replicates));
    else
      progress->Advance(effort.num_replicates);
    progress->Advance(1);
  });
  ForEachIndex(std::ssize(cells) * effort.num_replicates, num_threads, [&](std::int64_t index) {
    const auto c = static_cast<size_t>(index / effort.num_replicates);
    const auto r = static_cast<size_t>(index % effort.num_replicates);
    RareCell& cell = cells[c];
    if (cell.replicates.empty()) return;
    RandomStream rng = StreamOf(seed, plan.conditions[cell.condition], 1 + static_cast<std::uint32_t>(r));
    cell.replicates[r] = Split(systems[c], effort.splitting, cell.pilot.levels, rng);
    progress->Advance(1);
  });
  for (RareCell& cell : cells) cell.rate = RateOf(cell.pilot, cell.replicates);
  return cells;
}

}  // namespace rcme
