#include "experiments/scratch_folder.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <filesystem>

#include "parameters/input_error.h"

namespace rcme {

ScratchFolder::ScratchFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "rcme_XXXXXX").string();
  if (!mkdtemp(name.data())) throw InputError(fmt::format("{}: cannot be made", name));
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace rcme
