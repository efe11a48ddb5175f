// A lock records the content of a study with its hash before the run (docs/preregistration.md).
//
// It contains the whole study (ToYaml: descriptions, ADEMP block, seed, trials, data, factors, estimators
// with every option, failure bounds and hypotheses) and the digests of its real pairs. The path of the
// folder of pairs is not locked, because the same pairs may be elsewhere.
#pragma once

#include <string>
#include <vector>

#include "experiments/study/study_plan.h"

namespace rcme {

struct StudyLock {
  std::string locked_at;  // 2026-01-31T12:00:00Z, by the clock of the machine that made it
  std::string program;    // ProgramName() of the program that made it
  std::string sha256;     // of `text`
  std::string text;       // the locked content
};

StudyLock MakeLock(const StudyPlan& plan);

// Write and read a lock file, which is YAML. It is read line by line, because its text is longer than YAML
// input may be; messages call it `path`. ParseLock throws InputError if a key is missing or occurs twice, if
// there is no text, or if the text does not have the hash.
std::string ToYaml(const StudyLock& lock);
StudyLock ParseLock(const std::string& yaml, const std::string& path);

// Reads the text of a lock file. Throws InputError.
std::string ReadLockFile(const std::string& path);

// study.yaml -> study.lock.
std::string PathOfLockBeside(const std::string& study_path);

// Returns "with the lock 1234abcd", where the digits are the first of the hash in the lock file's text, or
// "without a lock".
std::string DescribeLock(const std::string& lock_yaml);

// Joins reasons for departing from a lock: one per line, without repetitions.
std::string JoinReasons(const std::string& reasons, const std::string& more);

// Returns how a run departs from its lock, one sentence per difference: "trials: 200 instead of 100",
// "estimator mine: was added". Each is one line of plain text, even if the lock contains control characters.
// `study_yaml`, `identity` and `stopping_rule` are those of the run (run_description.h).
std::vector<std::string> DeviationsFrom(const StudyLock& lock, const std::string& study_yaml,
                                        const std::string& identity, const std::string& stopping_rule);

// Hypotheses and number of trials in a text of ToYaml(Study) or in a lock. The run may come from another
// program.
struct WrittenPlan {
  std::vector<StatedHypothesis> hypotheses;
  int trials = 0;  // per condition
};
WrittenPlan ReadWrittenPlan(const std::string& study_yaml, const std::string& path);

}  // namespace rcme
