#include "experiments/study/estimator_file.h"
#include "tests/fuzz/harness/only_input_error.h"

// An estimator file: read, and written again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  return rcme::OnlyInputError([&] {
    rcme::EstimatorFileText(rcme::ParseEstimatorFile(rcme::AsText(data, size), "estimator.yaml"), {});
  });
}
