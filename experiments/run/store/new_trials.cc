#include "experiments/run/store/new_trials.h"

#include <fmt/format.h>

#include <filesystem>

#include "experiments/run/store/open_for_run.h"
#include "parameters/input_error.h"

namespace rcme {

NewResultFile::NewResultFile(const std::string& path, const RunDescription& run) : path_(path) {
  CheckPathToWrite(path);
  if (std::filesystem::exists(path))
    throw InputError(fmt::format("{}: exists already; give a new file", path));
  pending_.emplace(path);
  NamingFile(path_, [&] {
    file_.emplace(pending_->part(), SQLite::OPEN_READWRITE, FileLocks::kNone);
    // Needs no durability: no other process reads it, and after a crash it is made again.
    file_->database.exec(
        "PRAGMA journal_mode = MEMORY; PRAGMA synchronous = OFF; PRAGMA cache_size = -262144");
    file_->Create(run);
  });
}

void NewResultFile::Finish(const RunDescription& run) {
  NamingFile(path_, [&] {
    file_->SetDescription(run);
    file_.reset();
  });
  pending_->PutInPlace();
}

NewTrials::NewTrials(const std::string& path, const RunDescription& run) : file_(path, run) {
  NamingFile(path, [&] {
    writer_.emplace(&file_.file());
    transaction_.emplace(file_.file().database);
  });
}

void NewTrials::Add(const StoredTrial& trial) {
  NamingFile(file_.path(), [&] { writer_->AddTrial(trial.problem, trial.records); });
}

StoredTrial NewTrials::Read(std::uint32_t condition, std::uint32_t trial) {
  return NamingFile(file_.path(), [&] {
    return ReadStoredTrial(file_.file().database, file_.file().Frame(), condition, trial).value();
  });
}

void NewTrials::Finish(const RunDescription& run) {
  NamingFile(file_.path(), [&] {
    file_.file().totals.WriteChanged(file_.file().database);
    transaction_->commit();
  });
  transaction_.reset();
  writer_.reset();
  file_.Finish(run);
}

}  // namespace rcme
