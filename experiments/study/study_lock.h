// A lock: what a study says, written down with its hash before its run (docs/preregistration.md).
//
// Locked is the study in full (ToYaml: its words, ADEMP block, seed, trials, data, factors, estimators with
// every option, failure bounds and hypotheses) and the digests of its real pairs. The folder of pairs is not:
// the same pairs may lie elsewhere.
#pragma once

#include <string>
#include <vector>

#include "experiments/study/study_plan.h"

namespace rcme {

struct StudyLock {
  std::string locked_at;  // 2026-01-31T12:00:00Z, by the clock of who made it
  std::string program;    // ProgramName() there
  std::string sha256;     // of `text`
  std::string text;       // what is locked
};

StudyLock MakeLock(const StudyPlan& plan);

// The lock as a file, which is YAML, and read from one, line by line: its text is longer than a text of YAML
// input may be. `path` is what the messages call it. ParseLock throws InputError for what is no lock: a key
// that is missing or stands twice, no text, a text that does not have the hash.
std::string ToYaml(const StudyLock& lock);
StudyLock ParseLock(const std::string& yaml, const std::string& path);

// The text of a lock file. Throws InputError.
std::string ReadLockFile(const std::string& path);

// study.yaml -> study.lock.
std::string PathOfLockBeside(const std::string& study_path);

// "with the lock 1234abcd", by the first digits of the hash that the text of a lock file states; "without a
// lock" where there is none.
std::string DescribeLock(const std::string& lock_yaml);

// Reasons to depart from a lock, a line each, every one once.
std::string JoinReasons(const std::string& reasons, const std::string& more);

// How a run departs from its lock: one sentence a difference, "trials: 200 instead of 100", "estimator mine:
// was added", each of them one line of plain text, whoever wrote the lock. `study_yaml`, `identity`,
// `stopping_rule` are those of the run (run_description.h).
std::vector<std::string> DeviationsFrom(const StudyLock& lock, const std::string& study_yaml,
                                        const std::string& identity, const std::string& stopping_rule);

// What a text of ToYaml(Study), or a lock, says of these; the run may be of another program.
struct WrittenPlan {
  std::vector<StatedHypothesis> hypotheses;
  int trials = 0;  // per condition
};
WrittenPlan ReadWrittenPlan(const std::string& study_yaml, const std::string& path);

}  // namespace rcme
