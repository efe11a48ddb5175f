// Merges the result files of shards. A trial is a pure function of the study, its condition and its number.
// The union of the parts is therefore what a single run would have written, whichever machines computed
// them, however often they were interrupted, and in whatever order or groups they are merged.
//
// The parts are read one after the other, read-only and without locks, which a network file system may lack.
// Every trial is checked as it is read; a part that is still being written is at worst refused.
#pragma once

#include <string>
#include <vector>

#include "experiments/run/store/parts.h"

namespace rcme {

// Writes the trials of all parts to `out`, completely or not at all. If trials are missing, it writes only
// if `is_partial`. Throws InputError that names the part and the reason: it cannot be read or is damaged; it
// is of another study (the message has the first difference), program or instruction set; a trial differs
// from the same trial in another part. Also throws if `out` exists.
MergeReport MergeResults(const std::vector<std::string>& parts, const std::string& out, bool is_partial,
                         const MergeOptions& options);

// Reports what the parts hold together, and writes nothing. A part that cannot be read is named and skipped.
// Trials that occur twice are not compared. Throws InputError as MergeResults does for parts that do not
// belong together, and if no part can be read.
MergeReport CheckParts(const std::vector<std::string>& parts, const MergeOptions& options);

}  // namespace rcme
