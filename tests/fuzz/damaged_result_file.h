// A sound result file that tests damage, and what they ask of every damaged one: who reads it either gets the
// very same results as before (the damage was in unused space) or a refusal that names the file; and a run
// never calls it done.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/core/table/render_table.h"
#include "experiments/run/run_study.h"
#include "experiments/run/store/new_trials.h"
#include "experiments/run/store/salvage.h"
#include "experiments/statistics/compare.h"
#include "experiments/statistics/comparison_output.h"
#include "experiments/statistics/summary_output.h"
#include "experiments/statistics/trial_table.h"
#include "tests/test_support/small_study.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {

inline constexpr int kTrials = 12;    // per condition
inline constexpr size_t kPage = 512;  // bytes: small, so that little of the file is unused

// Runs SQL on a file, with all protection off; false if SQLite refuses it.
inline bool Execute(const std::string& path, const std::string& sql) {
  sqlite3* database = nullptr;
  sqlite3_open(path.c_str(), &database);
  sqlite3_exec(database, "PRAGMA synchronous = OFF", nullptr, nullptr, nullptr);  // no power fails here
  const bool is_done = sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK;
  sqlite3_close(database);
  return is_done;
}

// All that the commands say of a run: its summary with the times, its comparison, every record.
inline std::string ReadAllResults(const std::string& path) {
  const ResultStore store = ResultStore::OpenForReading(path);
  std::string text = SummaryAsCsv(Summarize(store, /*with_times=*/true)) +
                     RenderCsv(MakeComparisonResult(Compare(store, "")).rows) + store.Plan().study_yaml;
  WriteTrialTable(store, /*with_times=*/true, [&](const std::string& row) { text += row; });
  const RunDescription run = store.Description();
  text += fmt::format("{} {} {} {} {}", run.description, run.stopping_rule, run.until_options,
                      run.origin.program, run.origin.instruction_set);
  for (const DescribedEstimator& estimator : run.estimators) text += fmt::format(" {}", estimator.options);
  for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
    for (const TrialRecord& record : store.ReadTrialRecords(trial % 2, trial)) text += RecordText(record);
  }
  return text;
}

enum class FileOutcome { kSame, kRefused };

class DamagedResultFile : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    Study study = SmallStudy();
    study.trials = kTrials;
    plan_ = new StudyPlan(MakePlan(study));
    const std::string path = folder_->Path("sound.sqlite");
    {
      ResultStore store = ResultStore::OpenForRun(path, *plan_);
      RunStudy(*plan_, 1, &store);
    }
    EXPECT_TRUE(Execute(path, fmt::format("PRAGMA page_size = {}; VACUUM", kPage)));
    bytes_ = new std::string(ReadBytes(path));
    results_ = new std::string(ReadAllResults(path));
  }
  static void TearDownTestSuite() {
    delete folder_;
    delete plan_;
    delete bytes_;
    delete results_;
  }

  // The file with these bytes, and nothing beside it.
  std::string Write(const std::string& bytes) {
    for (const char* suffix : {"-journal", "-wal", "-shm"}) std::filesystem::remove(path_ + suffix);
    return folder_->Write("run.sqlite", bytes);
  }

  // What reading the file at path_ gives; anything but the same results or a refusal that names it is a
  // failure.
  FileOutcome Read(const std::string& what) {
    try {
      EXPECT_EQ(ReadAllResults(path_) == *results_, true) << what << ": changed in silence";
      return FileOutcome::kSame;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(path_), std::string::npos) << what << ": " << error.what();
      return FileOutcome::kRefused;
    }
  }
  // What resuming its run gives: refused, or done, and then it reads as before.
  FileOutcome Resume(const std::string& what) {
    try {
      ResultStore store = ResultStore::OpenForRun(path_, *plan_);
      EXPECT_EQ(RunStudy(*plan_, 1, &store).num_run_now, 0) << what << ": trials were lost in silence";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(path_), std::string::npos) << what << ": " << error.what();
      return FileOutcome::kRefused;
    }
    EXPECT_EQ(Read(what), FileOutcome::kSame) << what << ": done, but not readable";
    return FileOutcome::kSame;
  }
  void ExpectRefused(const std::string& what) {
    EXPECT_EQ(Read(what), FileOutcome::kRefused) << what;
    EXPECT_EQ(Resume(what), FileOutcome::kRefused) << what;
  }
  // Saves what is sound in the file at path_ and runs the rest; returns how many trials were saved.
  std::int64_t SaveAndComplete(const std::string& what) {
    const std::string saved = folder_->Path("saved.sqlite");
    std::filesystem::remove(saved);
    std::int64_t num_sound = 0;
    Salvage salvage(path_, plan_->study);
    {
      RunDescription run = salvage.description();
      run.stopping_rule.clear();  // where it is damaged, the intervals are others, so that they hold
      NewTrials store(saved, run);
      salvage.ForEachSoundTrial([&](const StoredTrial& trial) {
        store.Add(trial);
        ++num_sound;
      });
      store.Finish(run);
    }
    {
      ResultStore store = ResultStore::OpenForRun(saved, *plan_);
      EXPECT_EQ(RunStudy(*plan_, 1, &store).num_run_now, 2 * kTrials - num_sound) << what;
    }
    const Summary summary = Summarize(ResultStore::OpenForReading(saved), false);
    const Summary sound = Summarize(ResultStore::OpenForReading(folder_->Path("sound.sqlite")), false);
    EXPECT_EQ(SummaryAsCsv(summary), SummaryAsCsv(sound)) << what << ": other results after saving";
    return num_sound;
  }

  inline static TempFolder* folder_ = nullptr;
  inline static StudyPlan* plan_ = nullptr;
  inline static std::string *bytes_ = nullptr, *results_ = nullptr;
  const std::string path_ = folder_->Path("run.sqlite");
};

}  // namespace rcme
