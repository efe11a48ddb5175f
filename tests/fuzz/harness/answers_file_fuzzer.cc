#include "estimator/estimator_registry.h"
#include "experiments/study/estimator_spec.h"
#include "peers/peer_registry.h"
#include "tests/fuzz/harness/file_in_memory.h"
#include "tests/fuzz/harness/only_input_error.h"
#include "tests/fuzz/harness/outside_problem.h"

// A file of answers, as `rcme import` reads and scores it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  using namespace rcme;
  static const FileInMemory file;
  static const bool is_added = [] {
    AddOutsideEstimators();
    return true;
  }();
  const std::string text = WithProblemId(AsText(data, size));
  file.Write(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  return is_added
             ? OnlyInputError([&] { AskAndJudge(*MakeEstimator("answers", AnswersOptions(file.path()))); })
             : 1;
}
