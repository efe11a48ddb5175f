#include "tests/fuzz/harness/dataset_inputs.h"
#include "tests/fuzz/harness/only_input_error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  return rcme::OnlyInputError([&] { rcme::ReadEurocInput(rcme::AsText(data, size)); });
}
