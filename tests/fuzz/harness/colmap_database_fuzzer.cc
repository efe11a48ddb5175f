#include "tests/fuzz/harness/colmap_tables.h"
#include "tests/fuzz/harness/only_input_error.h"

// What the tables of a COLMAP database hold: SQLite's own format is SQLite's to check.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  return rcme::OnlyInputError([&] { rcme::ReadColmapTablesInput(data, size); });
}
