// The small study in shards, a result file of each, and what is merged from them.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/run/store/merge_results.h"
#include "tests/test_support/small_study.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {

// A test says how the trials of a shard are run and merged.
class ShardFiles : public testing::Test {
 protected:
  using Paths = std::vector<std::string>;

  explicit ShardFiles(int trials) { study_.trials = trials; }

  virtual void RunShard(const StudyPlan& plan, const Shard& shard, const std::string& path) const = 0;
  virtual MergeReport MergeFiles(const Paths& parts, const std::string& out, bool is_partial,
                                 const MergeOptions& options) const = 0;

  std::string Run(const Shard& shard, const std::string& prefix = "part") const {
    const std::string path = folder_.Path(fmt::format("{}_{}_{}.sqlite", prefix, shard.number, shard.count));
    RunShard(MakePlan(study_), shard, path);
    return path;
  }
  Paths RunAll(std::uint32_t count) const {
    Paths parts;
    for (std::uint32_t number = 1; number <= count; ++number) parts.push_back(Run({number, count}));
    return parts;
  }
  std::string Merge(const Paths& parts, bool is_partial = false, const MergeOptions& options = {}) {
    const std::string out = folder_.Path(fmt::format("merged_{}.sqlite", num_merged_++));
    last_ = MergeFiles(parts, out, is_partial, options);
    return out;
  }
  static void Change(const std::string& path, const std::string& sql) {
    sqlite3* database = nullptr;
    sqlite3_open(path.c_str(), &database);
    EXPECT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK) << sql;
    sqlite3_close(database);
  }

  TempFolder folder_;
  Study study_ = SmallStudy();
  int num_merged_ = 0;
  MergeReport last_;  // of the last Merge
};

}  // namespace rcme
