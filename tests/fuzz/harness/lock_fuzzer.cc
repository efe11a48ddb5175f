#include <cstdlib>
#include <nlohmann/json.hpp>

#include "experiments/core/files/sha256.h"
#include "experiments/statistics/preregistration_output.h"
#include "experiments/study/study_lock.h"
#include "experiments/study/study_plan.h"
#include "parameters/plain_text.h"
#include "tests/fuzz/harness/only_input_error.h"
#include "tests/test_support/small_study.h"

namespace rcme {
namespace {

// The run whose lock and study are replaced, described once: an input shall cost little beside its own
// reading.
const RunDescription& OwnRun() {
  static const RunDescription run = Describe(MakePlan(SmallStudy()));
  return run;
}

// What a lock of this text is as a file; no mutation would find its hash.
std::string MakeLockFile(std::string text) {
  if (!text.ends_with('\n')) text += '\n';
  return ToYaml(StudyLock{"2026-01-31T12:00:00Z", "rcme 0.1.0", Sha256(text), text});
}

// What is said of a run's lock is plain text and JSON; a run with a lock always has something said.
void Say(const std::string& lock, const std::string& study_yaml) {
  RunDescription run = OwnRun();
  run.lock = lock;
  run.study_yaml = study_yaml;
  const std::optional<Preregistration> said = DescribePreregistered(run, "run.sqlite");
  if (!said) {
    if (lock.empty()) return;
    std::abort();
  }
  for (const std::string& deviation : said->deviations) {
    if (FindNotInLine(deviation) != std::string::npos) std::abort();
  }
  if (FindNotPlain(PreregistrationAsText(*said)) != std::string::npos) std::abort();
  PreregistrationAsJson(*said).dump();
}

// A lock that is read is written and read again as it is.
void ReadLockTwice(const std::string& yaml) {
  const StudyLock lock = ParseLock(yaml, "study.lock");
  const StudyLock again = ParseLock(ToYaml(lock), "again.lock");
  if (again.text != lock.text || again.sha256 != lock.sha256) std::abort();
  Say(yaml, OwnRun().study_yaml);
}

}  // namespace
}  // namespace rcme

// A lock file as it is; a lock of this text, whose hash is right; a run whose study is this text, with the
// lock of another study and with none.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  using namespace rcme;
  const std::string text = AsText(data, size);
  DescribeLock(text);
  OnlyInputError([&] { ReadLockTwice(text); });
  OnlyInputError([&] { ReadLockTwice(MakeLockFile(text)); });
  static const std::string own_lock = MakeLockFile(OwnRun().study_yaml);
  OnlyInputError([&] { Say(own_lock, text); });
  OnlyInputError([&] { Say("", text); });
  return 0;
}
