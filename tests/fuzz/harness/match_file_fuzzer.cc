#include "experiments/data/match_file.h"
#include "tests/fuzz/harness/file_in_memory.h"
#include "tests/fuzz/harness/only_input_error.h"

// A match file, plain or gzip, by the first bytes.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  static rcme::FileInMemory file;
  file.Write(data, size);
  return rcme::OnlyInputError([&] { rcme::ReadMatchFile(file.path()); });
}
