// What can be saved of a damaged result file: every trial whose rows can be reached and whose checksum is
// right. A trial is a pure function of the study, so that a run computes the others again.
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
  std::optional<std::int64_t>
      num_counted;  // trials that the file says it holds; not known if that is damaged
};

class Salvage {
 public:
  // `study`: in place of the one in the file, where that is damaged too. Throws InputError if nothing can be
  // saved: the study or the table of problems or trials is gone.
  explicit Salvage(const std::string& path, const std::optional<Study>& study = std::nullopt);

  // Of a run that computes what is not saved. Where the description in the file is damaged, it asks for one
  // trial per condition, for how many there were is not known: who runs it says so again. The stopping rule
  // has a checksum of its own; where that is not right either, it says that the rule is not known, so that
  // intervals hold whatever it was.
  const RunDescription& description() const { return description_; }

  // Hands every sound trial to `keep`, ordered by condition and trial; returns what each condition holds.
  std::vector<SalvagedCondition> ForEachSoundTrial(const std::function<void(const StoredTrial&)>& keep);
  // What was found, in words: the first few.
  const std::vector<std::string>& findings() const { return findings_; }

 private:
  // The one in the file; nothing if it is damaged.
  std::optional<RunDescription> ReadStored();
  // Of the study in the file, which may be readable where the other tables are not.
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
