// Studies whose trials cost next to nothing, so that what is left is the engine.
#pragma once

#include <string>

#include "experiments/study/study_plan.h"

namespace rcme {

// Estimators that answer the same motion for every problem: at once, and after about 80 microseconds of
// arithmetic in registers.
inline constexpr const char* kNoWork = "no_work";
inline constexpr const char* k80Microseconds = "80_us";

// Two conditions with the same 500 matches, which are not made anew.
StudyPlan EnginePlan(const std::string& estimator, int trials_per_condition);

// A result file that does not exist yet and is gone in the end. In memory (/dev/shm) where the machine has
// that: on a disk the first commit of a study took between 3 and 90 ms.
class ScratchFile {
 public:
  ScratchFile();
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

// Runs a study into a scratch file.
void RunToScratchFile(const StudyPlan& plan, int num_threads);

}  // namespace rcme
