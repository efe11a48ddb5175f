// What a gate must not change once it has looked at trials: what it judges with which margins, and the
// programs that gave the trials. With margins that were chosen after a look, the verdict is wrong more often
// than its level says; trials of an earlier build say nothing of this one. All of it is noted with the trials
// as their stopping rule.
#pragma once

#include <string>
#include <vector>

#include "experiments/gate/gate_quantity.h"
#include "experiments/study/estimator_spec.h"
#include "experiments/study/run_description.h"

namespace rcme {

struct GateTerms {
  std::string judged;  // "failure=0.005, time=0.05, against standard"
  // "build of rcme 0123456789abcdef": a hash of the bytes of this program, and one for each version that is a
  // process of its own, of the files that its command names.
  std::vector<std::string> builds;

  // One line; two are equal only if all of the above is.
  std::string AsStoppingRule() const;
};

// `old_label` is empty where no old version is judged; `versions` are those that the trials are of.
// `baseline`: what identifies an old version whose trials are in a file (IdentifyVersion); a verdict against
// another one needs another folder.
GateTerms MakeGateTerms(const std::vector<GateTest>& tests, const std::string& old_label,
                        const std::vector<EstimatorSpec>& versions, const std::string& baseline = "");

// A version whose trials a file holds: its label says nothing of what gave them.
struct RecordedVersion {
  DescribedEstimator estimator;
  TrialOrigin origin;
  std::string stopping_rule;  // of its file; that of a gate has the hashes of its builds
};
RecordedVersion FindRecordedVersion(const RunDescription& run, size_t estimator);

// All of it, in a line of text for each: two are equal only if the versions are.
std::string IdentifyVersion(const RecordedVersion& version);

// "old: five_point of rcme 0.1.0 (avx2); new: the same estimator with other options (num_iterations 200, not
// 100), of rcme 0.2.0 (avx2)".
std::string CompareVersions(const RecordedVersion& of_old, const RecordedVersion& of_new);

// One label for what is not the same estimator with the same options.
bool HasMisleadingLabel(const RecordedVersion& of_old, const RecordedVersion& of_new);

// A hash of the bytes of each regular file that the shell command names, in its order; what it finds by PATH
// and what these files read are not in it.
std::string HashFilesOfCommand(const std::string& command);

// Throws InputError if the trials in `path` were judged with other terms, and says which.
void RequireSameTerms(const GateTerms& terms, const std::string& stored_rule, const std::string& path);

}  // namespace rcme
