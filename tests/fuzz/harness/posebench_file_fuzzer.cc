#include "experiments/real/sequences/listed_pairs.h"
#include "tests/fuzz/harness/file_in_memory.h"
#include "tests/fuzz/harness/only_input_error.h"

// An HDF5 file of pairs: whatever becomes of the process that reads it, this one goes on.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  static rcme::FileInMemory file;
  file.Write(data, size);
  return rcme::OnlyInputError([&] {
    rcme::DatasetOptions options;
    options.folder = file.path();
    const auto pairs = rcme::OpenPosebench(options);
    for (size_t i = 0; i < pairs->size(); ++i) rcme::OnlyInputError([&] { pairs->Read(i); });
  });
}
