// Describes long work as a list of items. Each item is a pure function of the plan; the items of a group have
// similar cost. The runner (core/work/runner.h) computes the items; a shard (core/work/shard.h) is a fixed
// share of them.
#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <vector>

#include "experiments/core/work/shard.h"

namespace rcme {

// Indices into WorkPlan::groups and into the group's items.
struct ItemPlace {
  size_t group = 0, item = 0;
  auto operator<=>(const ItemPlace&) const = default;
};

struct ItemGroup {
  std::string name;  // for messages: "claim sigma_f.seven_point"
  size_t num_items = 0;
};

struct WorkPlan {
  std::string work;       // the command's product: "audit"
  std::string item_name;  // "block"
  std::string identity;   // everything that the results depend on, one thing a line
  std::vector<ItemGroup> groups;
  bool is_open = false;  // the number of items is not known in advance; groups is empty

  bool Has(const ItemPlace& place) const;
};

// The plan's identity followed by its groups; equal for the parts of one work.
std::string DescribeIdentity(const WorkPlan& plan);

// The shard of an item: FindShard (core/work/shard.h) of its group and item. The items of every group, cheap
// or expensive, are thus divided evenly to within one.
std::uint32_t FindShardOfItem(const ItemPlace& place, std::uint32_t count);

// The shard's items, in order: those of the groups first, ..., end - 1, or of all groups.
std::vector<ItemPlace> ListItems(const WorkPlan& plan, const Shard& shard, size_t first, size_t end);
std::vector<ItemPlace> ListItems(const WorkPlan& plan, const Shard& shard);

}  // namespace rcme
