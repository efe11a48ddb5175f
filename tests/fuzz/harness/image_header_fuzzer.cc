#include "experiments/real/images/image_header.h"
#include "tests/fuzz/harness/only_input_error.h"

// The first bytes of an image.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  return rcme::OnlyInputError([&] { rcme::ReadImageHeader(rcme::AsText(data, size)); });
}
