// The terms of a gate: its quantities, its margins and the programs under test. They must not change once the
// gate has looked at trials: a verdict with margins chosen after a look is wrong more often than its level
// says, and trials of an earlier build say nothing about this one. The terms are stored with the trials as
// their stopping rule.
#pragma once

#include <string>
#include <vector>

#include "experiments/gate/gate_quantity.h"
#include "experiments/study/estimator_spec.h"
#include "experiments/study/run_description.h"

namespace rcme {

struct GateTerms {
  std::string judged;  // "failure=0.005, time=0.05, against standard"
  // "build of rcme 0123456789abcdef": a hash of this program's bytes. One more entry for each version that
  // runs as an external process: a hash of the files that its command names.
  std::vector<std::string> builds;

  // One line; equal only for equal terms.
  std::string AsStoppingRule() const;
};

// `old_label` is empty if only limits are tested. `versions` are the estimators whose trials are computed.
// `baseline` is IdentifyVersion of an old version whose trials are read from a file, else empty; a verdict
// against another baseline needs another folder.
GateTerms MakeGateTerms(const std::vector<GateTest>& tests, const std::string& old_label,
                        const std::vector<EstimatorSpec>& versions, const std::string& baseline = "");

// A version whose trials are in a file. Its label alone does not identify the program that computed them.
struct RecordedVersion {
  DescribedEstimator estimator;
  TrialOrigin origin;
  std::string stopping_rule;  // of its file; a gate's contains the hashes of its builds
};
RecordedVersion FindRecordedVersion(const RunDescription& run, size_t estimator);

// All fields as text, one a line; equal only for equal versions.
std::string IdentifyVersion(const RecordedVersion& version);

// "old: five_point of rcme 0.1.0 (avx2); new: the same estimator with other options (num_iterations 200, not
// 100), of rcme 0.2.0 (avx2)".
std::string CompareVersions(const RecordedVersion& of_old, const RecordedVersion& of_new);

// Whether the two have the same label but differ in estimator or options.
bool HasMisleadingLabel(const RecordedVersion& of_old, const RecordedVersion& of_new);

// Throws InputError that names the difference if the trials in `path` were judged with other terms.
void RequireSameTerms(const GateTerms& terms, const std::string& stored_rule, const std::string& path);

}  // namespace rcme
