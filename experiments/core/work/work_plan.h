// Long work as a list of items, each a pure function of the plan, in groups of items with similar cost. The
// runner (core/work/runner.h) computes them; a shard (core/work/shard.h) has a fixed share of them.
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
  std::string work;       // what the command makes: "audit"
  std::string item_name;  // "block"
  std::string identity;   // what the results depend on, a line for each thing
  std::vector<ItemGroup> groups;
  bool is_open = false;  // how many items there are shows as they are computed: there are no groups

  bool Has(const ItemPlace& place) const;
  size_t NumItems() const;
};

// Equal for the parts of one work: its identity, then its groups.
std::string DescribeIdentity(const WorkPlan& plan);

// The shard that has the item: FindShard (core/work/shard.h) of group and item, so that the items of every
// group, cheap or dear, are divided evenly to within one.
std::uint32_t FindShardOfItem(const ItemPlace& place, std::uint32_t count);

// Those of the shard in the groups first, ..., end - 1, in their order.
std::vector<ItemPlace> ListItems(const WorkPlan& plan, const Shard& shard, size_t first, size_t end);
std::vector<ItemPlace> ListItems(const WorkPlan& plan, const Shard& shard);

}  // namespace rcme
