#include "tests/fuzz/harness/dataset_inputs.h"
#include "tests/fuzz/harness/only_input_error.h"

// The same input as bytes and as text.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  rcme::OnlyInputError([&] { rcme::ReadColmapBytesInput(rcme::AsText(data, size)); });
  return rcme::OnlyInputError([&] { rcme::ReadColmapTextInput(rcme::AsText(data, size)); });
}
