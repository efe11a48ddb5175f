// The result files of shards as one. A trial is a pure function of the study, its condition and its number,
// so that the union of the parts is what one run would have written, whatever they were computed by, how
// often they were cut off, and in what order or groups they are merged.
//
// The parts are read one after the other, read-only and without locks, which a network file system may lack;
// every trial is checked as it is read, so that a part that is still being written is at worst refused.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/run/store/parts.h"

namespace rcme {

// Which trials some files hold together.
class TrialsHeld {
 public:
  // False: it is held already.
  bool Add(std::uint32_t condition, std::uint32_t trial);
  void AddAll(const TrialsHeld& other);
  bool Has(std::uint32_t condition, std::uint32_t trial) const;
  std::int64_t num_trials() const { return num_trials_; }

 private:
  std::vector<std::vector<bool>> held_;  // per condition
  std::int64_t num_trials_ = 0;
};

// Writes the parts to `out`, whole or not at all: where trials are missing, only if `is_partial`. Throws
// InputError that names the part and what is wrong: it cannot be read or is damaged, it is of another study
// (the first difference is named), program or instruction set, or a trial differs from the same one of
// another part; and if `out` exists.
MergeReport MergeResults(const std::vector<std::string>& parts, const std::string& out, bool is_partial,
                         const MergeOptions& options);

// What the parts hold together; nothing is written. A part that cannot be read is named and left aside.
// Trials that are there twice are not compared. Throws InputError as MergeResults does for parts that do not
// belong together, and if no part can be read.
MergeReport CheckParts(const std::vector<std::string>& parts, const MergeOptions& options);

}  // namespace rcme
