#include "experiments/run/store/new_trials.h"

namespace rcme {

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
