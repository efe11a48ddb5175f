// What can be saved of a damaged result file: every trial whose rows can be reached and whose checksum is
// right. A trial is a pure function of the study, so that a run computes the others again.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/result_file/result_file.h"
#include "experiments/result_file/result_store.h"

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

  // A run of it computes what is not saved. Where the study in the file is damaged, it asks for one trial per
  // condition, for how many there were is not known: who runs it says so again.
  const StudyPlan& plan() const { return plan_; }
  // As in the file; where that is damaged, a rule that says so: intervals then hold whatever the rule was.
  const std::string& stopping_rule() const { return stopping_rule_; }
  const TrialOrigin& origin() const { return origin_; }

  // Hands every sound trial to `keep`, ordered by condition and trial; returns what each condition holds.
  std::vector<SalvagedCondition> ForEachSoundTrial(const std::function<void(const StoredTrial&)>& keep);
  // What was found, in words: the first few.
  const std::vector<std::string>& findings() const { return findings_; }

 private:
  // The study in the file.
  Study ReadStudy();
  // The stopping rule and the origin.
  void ReadFacts();
  SalvagedCondition SalvageCondition(std::uint32_t condition,
                                     const std::function<void(const StoredTrial&)>& keep);
  void Note(const std::string& finding);

  ResultFile file_;
  TrialFrame frame_;
  StudyPlan plan_;
  std::string stopping_rule_;
  TrialOrigin origin_;
  std::optional<TrialTotals> totals_;
  std::vector<std::string> findings_;
};

}  // namespace rcme
