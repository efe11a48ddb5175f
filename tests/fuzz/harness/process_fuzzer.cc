#include "estimator/estimator_registry.h"
#include "peers/peer_registry.h"
#include "tests/fuzz/harness/outside_problem.h"
#include "tests/test_support/temp_folder.h"

// All that a process writes after one question, until its end.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  using namespace rcme;
  static const TempFolder folder;
  static const std::unique_ptr<MotionEstimator> estimator = [] {
    AddOutsideEstimators();
    return MakeEstimator(
        "process", {{"command", "read -r line; cat '" + folder.Path("said") + "'"}, {"timeout_s", "100"}});
  }();
  folder.Write("said", WithProblemId({reinterpret_cast<const char*>(data), size}));
  if (AskAndJudge(*estimator).status == MotionStatus::kTimedOut) std::abort();  // the process has ended
  return 0;
}
