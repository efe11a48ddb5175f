#include "tests/fuzz/harness/only_input_error.h"
#include "tests/fuzz/harness/outside_problem.h"

// One line as a process answers it: read, completed, judged.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  using namespace rcme;
  const AnswerLine line = AnswerFromJson(WithProblemId(AsText(data, size)));
  const MotionProblem& problem = OutsideProblem();
  Judged(CallOutside(problem, [&] { return ReadableAnswerTo(OutsideProblemId(), line); }),
         problem.matches.size());
  return 0;
}
