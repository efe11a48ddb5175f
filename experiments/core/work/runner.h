// Computes the items of a work plan (core/work/work_plan.h), keeps their results and reads them back.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "experiments/core/work/item_loop.h"
#include "experiments/core/work/part_file.h"

namespace rcme {

// The results of a work plan, with the files that they were read from.
struct WorkResults {
  std::uint32_t num_shards = 1;  // of each file
  ItemResults results;
  std::map<ItemPlace, std::string> paths;  // the part that a result was read from
  std::string kept_in;                     // the checkpoint or shard file, for results without such a path
};

// The items of a selection that have no result.
struct MissingItems {
  size_t num_items = 0;
  std::vector<std::uint32_t> shards;  // the shards that these items belong to, ascending
};
MissingItems FindMissingAmong(const std::vector<ItemPlace>& places, const WorkResults& results);
// The same among all items of the groups first, ..., end - 1.
MissingItems FindMissingIn(const WorkPlan& plan, const WorkResults& results, size_t first, size_t end);

// Thrown if the parts lack items that a command needs.
struct ItemsAreMissing {
  std::string message, shards;  // for people; the missing shards as ArrayText
};
// Throws ItemsAreMissing unless num_items is 0.
void RequireNoneMissing(const WorkPlan& plan, const MissingItems& missing, std::uint32_t num_shards);

// Computes an item: the text of a JSON value on one line, a pure function of the place. Called from several
// threads.
using ComputeItem = std::function<std::string(const ItemPlace& place)>;

// The unit of progress; the default counts items.
struct ProgressUnit {
  std::string name;
  std::function<std::int64_t(const ItemPlace& place)> amount;  // number of units in an item
};

// A command asks the runner for the results of some items, and then reads them. The runner computes them, or
// takes them from an earlier call of the same command or from other machines; the command's code is the same:
//
//   Runner runner = Runner::WithCheckpoint(plan, "out/unfinished.part", num_threads);
//   runner.Get(ListItems(plan, runner.shard()), compute);
//   ReadResults(plan, runner.results(), 0, plan.groups.size(), read);
//   runner.RemoveCheckpoint();
//
// The file is written every ten seconds, less often if a write takes more than one second. It is also written
// at the end of Get, after a request to stop and after an error. Each write replaces the whole file or fails.
class Runner : private ItemKeeper {
 public:
  // Keeps nothing.
  static Runner InMemory(const WorkPlan& plan, int num_threads);
  // Keeps results in the file at `path` until RemoveCheckpoint, and continues from an existing file. Damaged
  // items of that file are computed again, after a warning. Throws InputError that says what to do if the
  // file is of another work or its first line is damaged.
  static Runner WithCheckpoint(const WorkPlan& plan, const std::string& path, int num_threads);
  // Keeps a shard's results in the part at `path`, and continues from an existing part as above. Throws
  // InputError if the file is another part or cannot be written.
  static Runner OfShard(const WorkPlan& plan, const Shard& shard, const std::string& path, int num_threads);
  // Reads the parts of all shards and computes nothing. Throws as MergeParts does.
  static Runner FromParts(const WorkPlan& plan, const std::vector<std::string>& paths);

  // Computes the missing results of these items on the runner's threads (num_threads; 0: one per core) and
  // shows progress. Throws Stopped, whose message says how many items are kept, KeptResultsError if the file
  // cannot be written, and ItemsAreMissing if a runner FromParts lacks items.
  void Get(const std::vector<ItemPlace>& places, const ComputeItem& compute, const ProgressUnit& unit = {});

  // The same for one item of an open plan, whose items are taken in order. Throws std::logic_error for a
  // runner FromParts.
  void GetOne(const ItemPlace& place, const ComputeItem& compute);

  const WorkPlan& plan() const { return plan_; }
  const WorkResults& results() const { return results_; }
  const Shard& shard() const { return part_.shard; }
  bool ReadsParts() const { return kind_ == Kind::kParts; }

  // Removes the checkpoint; to be called once the command's output is written.
  void RemoveCheckpoint();

 private:
  enum class Kind { kMemory, kCheckpoint, kShard, kParts };
  Runner(Kind kind, const WorkPlan& plan, const Shard& shard, const std::string& path, int num_threads);

  void OpenFile();
  void ComputeAll(const std::vector<ItemPlace>& places, const ComputeItem& compute, const ProgressUnit& unit);
  void ComputeOne(const ItemPlace& place, const ComputeItem& compute);
  void Keep(const ItemPlace& place, ItemResult result);
  void Flush() override;
  std::string DescribeKept(std::int64_t) const override;

  Kind kind_;
  WorkPlan plan_;
  int num_threads_;
  std::string path_;
  Part part_;  // without results
  bool is_too_long_ = false;
  size_t num_written_ = 0;  // items in the file
  std::chrono::steady_clock::time_point next_write_;
  std::unique_ptr<std::mutex> mutex_ = std::make_unique<std::mutex>();  // guards results_ and next_write_
  WorkResults results_;
};

// Merges the parts of a work; their order is free, and some may be joined parts. An item that is in several
// parts counts once. Throws InputError that names the part and the difference if
//   - a part is of another work, program, instruction set or number of shards,
//   - an item has different results in two parts, or
//   - a part has an item that is not of its shard or not of the plan.
WorkResults MergeParts(const WorkPlan& plan, const std::vector<std::string>& paths);

// Joins parts of any one work into one part. Throws InputError as above, but needs no plan: it does not check
// that a part's items are of its shard.
Part JoinParts(const std::vector<std::string>& paths);

// Describes the processor time for people: the total, and the slowest shard and the slowest item relative to
// the mean of the shards. No division into shards is faster than the slowest item.
std::string DescribeCosts(const WorkPlan& plan, const WorkResults& results);

// The file of results cannot be written, or a ReadItem threw std::exception for a result from it. In that
// case the message names the file and the item.
class KeptResultsError : public InputError {
  using InputError::InputError;
};
using ReadItem = std::function<void(const ItemPlace&, const std::string& json)>;
// Calls `read` with the result of an item. Throws KeptResultsError.
void ReadResult(const WorkPlan& plan, const WorkResults& results, const ItemPlace& place,
                const ReadItem& read);
// Calls `read` for all results of the groups first, ..., end - 1, in order.
void ReadResults(const WorkPlan& plan, const WorkResults& results, size_t first, size_t end,
                 const ReadItem& read);

}  // namespace rcme
