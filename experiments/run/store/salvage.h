// Recovers trials from a damaged result file: every trial whose rows can be reached and whose checksum is
// right. A run computes the others again, as a trial is a pure function of the study.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/run/store/result_file.h"
#include "experiments/run/store/result_store.h"

namespace rcme {

struct SalvagedCondition {
  std::vector<TrialRange> sound;  // ascending
  std::int64_t num_sound = 0;
  std::optional<std::int64_t> num_counted;  // number in the table `totals`; empty if that is damaged
};

class Salvage {
 public:
  // `study` replaces that of the file, for a file whose study is damaged too. Throws InputError if nothing
  // can be recovered, because the study or the table of problems or trials is lost.
  explicit Salvage(const std::string& path, const std::optional<Study>& study = std::nullopt);

  // Returns the description of a run that computes what cannot be recovered. If the description in the file
  // is damaged, it plans one trial per condition, because the planned number is lost; the next run states it
  // again. The stopping rule has a checksum of its own. If that is wrong too, the description says that the
  // rule is not known, and the intervals are those that hold for any rule.
  const RunDescription& description() const { return description_; }

  // Passes every undamaged trial to `keep`, ordered by condition and trial. Returns the result by condition.
  std::vector<SalvagedCondition> ForEachSoundTrial(const std::function<void(const StoredTrial&)>& keep);
  // Returns messages about the damage, at most the first few.
  const std::vector<std::string>& findings() const { return findings_; }

 private:
  // Returns the description in the file; nothing if it is damaged.
  std::optional<RunDescription> ReadStored();
  // Describes the study in the file, which may be readable even if other tables are not.
  RunDescription DescribeStudy();
  SalvagedCondition SalvageCondition(std::uint32_t condition,
                                     const std::function<void(const StoredTrial&)>& keep);
  void Note(const std::string& finding);

  ResultFile file_;
  TrialFrame frame_;
  RunDescription description_;
  std::optional<TrialTotals> totals_;
  std::vector<std::string> findings_;
};

}  // namespace rcme
