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

// Results of a work with the files that they are from.
struct WorkResults {
  std::uint32_t num_shards = 1;  // of each file
  ItemResults results;
  std::map<ItemPlace, std::string> paths;  // of the part that a result is from ...
  std::string kept_in;                     // ... or of the one file that keeps all others
};

// What results lack of some items.
struct MissingItems {
  size_t num_items = 0;
  std::vector<std::uint32_t> shards;  // that have them, ascending
};
MissingItems FindMissingAmong(const std::vector<ItemPlace>& places, const WorkResults& results);
// Of the groups first, ..., end - 1.
MissingItems FindMissingIn(const WorkPlan& plan, const WorkResults& results, size_t first, size_t end);

// Thrown where parts lack what is asked for.
struct ItemsAreMissing {
  std::string message, shards;  // for people; for the shell, as Slurm wants the tasks of an array
};
// Throws it if any are.
void RequireNoneMissing(const WorkPlan& plan, const MissingItems& missing, std::uint32_t num_shards);

// A pure function of the item: the text of a JSON value on one line. Called from several threads.
using ComputeItem = std::function<std::string(const ItemPlace& place)>;

// What progress counts; without it items.
struct ProgressUnit {
  std::string name;
  std::function<std::int64_t(const ItemPlace& place)> amount;  // in an item
};

// A command asks the runner for the results of some items, and then reads them. Whether they are computed,
// were computed before by the same command, or by other machines makes no difference to it:
//
//   Runner runner = Runner::WithCheckpoint(plan, "out/unfinished.part", num_threads);
//   runner.Get(ListItems(plan, runner.shard()), compute);
//   ReadResults(plan, runner.results(), 0, plan.groups.size(), read);
//   runner.RemoveCheckpoint();
//
// A file is written every ten seconds, at the end of Get, when a request stops it and on an error, whole or
// not at all.
class Runner : private ItemKeeper {
 public:
  // Keeps nothing.
  static Runner InMemory(const WorkPlan& plan, int num_threads);
  // Keeps results in the file at `path` until RemoveCheckpoint; goes on with what it holds. Throws InputError
  // that says what to do if it holds another work, or is damaged.
  static Runner WithCheckpoint(const WorkPlan& plan, const std::string& path, int num_threads);
  // A shard's part. Throws InputError if the file holds another one, or could not be written.
  static Runner OfShard(const WorkPlan& plan, const Shard& shard, const std::string& path, int num_threads);
  // Computes nothing: reads the parts of all shards. Throws as MergeParts.
  static Runner FromParts(const WorkPlan& plan, const std::vector<std::string>& paths);

  // Makes sure that the results of these items are there: computes those that are not, on the runner's
  // threads (0: one per core), and shows progress. Throws Stopped that says how far it has come;
  // KeptResultsError if a file cannot be written; ItemsAreMissing where only parts are read.
  void Get(const std::vector<ItemPlace>& places, const ComputeItem& compute, const ProgressUnit& unit = {});

  // The same of one item of an open plan, which follows those before it. Throws std::logic_error for a runner
  // that reads parts.
  void GetOne(const ItemPlace& place, const ComputeItem& compute);

  const WorkPlan& plan() const { return plan_; }
  const WorkResults& results() const { return results_; }
  const Shard& shard() const { return part_.shard; }
  bool ReadsParts() const { return kind_ == Kind::kParts; }

  // Once what the results are for is written.
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
  std::unique_ptr<std::mutex> mutex_ = std::make_unique<std::mutex>();  // of what follows, and next_write_
  WorkResults results_;
};

// The parts of the work, in any order and grouping. An item that two have counts once. Throws InputError that
// names the part and what differs for one of another work, program or number of shards, for one of another
// instruction set than the first, for an item that is not equal in two parts, and for one that its part
// cannot have.
WorkResults MergeParts(const WorkPlan& plan, const std::vector<std::string>& paths);

// One part that holds what these hold, of whatever work; refused as above.
Part JoinParts(const std::vector<std::string>& paths);

// What the items took, for people: in all, by the slowest shard beside the mean, and by the slowest item,
// which no shard can take less than.
std::string DescribeCosts(const WorkPlan& plan, const WorkResults& results);

// The file that keeps results cannot be written, or holds what `read` cannot read (it throws std::exception):
// the message names the file and the item.
class KeptResultsError : public InputError {
  using InputError::InputError;
};
using ReadItem = std::function<void(const ItemPlace&, const std::string& json)>;
// Hands over the result of an item. Throws KeptResultsError.
void ReadResult(const WorkPlan& plan, const WorkResults& results, const ItemPlace& place,
                const ReadItem& read);
// Those of these groups, in their order.
void ReadResults(const WorkPlan& plan, const WorkResults& results, size_t first, size_t end,
                 const ReadItem& read);

}  // namespace rcme
