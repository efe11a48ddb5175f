#include "experiments/core/work/work_plan.h"

#include <fmt/format.h>

namespace rcme {

bool WorkPlan::Has(const ItemPlace& place) const {
  return is_open || (place.group < groups.size() && place.item < groups[place.group].num_items);
}

std::string DescribeIdentity(const WorkPlan& plan) {
  std::string identity = plan.identity;
  for (const ItemGroup& group : plan.groups) {
    identity += fmt::format("{}: {} {}s\n", group.name, group.num_items, plan.item_name);
  }
  return identity;
}

std::uint32_t FindShardOfItem(const ItemPlace& place, std::uint32_t count) {
  return FindShard(static_cast<std::uint32_t>(place.group), static_cast<std::uint32_t>(place.item), count);
}

std::vector<ItemPlace> ListItems(const WorkPlan& plan, const Shard& shard, size_t first, size_t end) {
  std::vector<ItemPlace> places;
  for (size_t group = first; group < end; ++group) {
    for (size_t item = 0; item < plan.groups[group].num_items; ++item) {
      if (FindShardOfItem({group, item}, shard.count) == shard.number) places.push_back({group, item});
    }
  }
  return places;
}

std::vector<ItemPlace> ListItems(const WorkPlan& plan, const Shard& shard) {
  return ListItems(plan, shard, 0, plan.groups.size());
}

}  // namespace rcme
