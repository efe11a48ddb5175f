#include "experiments/study/study_file.h"
#include "tests/fuzz/harness/only_input_error.h"

// A study file: read, and written again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  return rcme::OnlyInputError(
      [&] { rcme::ToYaml(rcme::ParseStudy(rcme::AsText(data, size), "study.yaml")); });
}
