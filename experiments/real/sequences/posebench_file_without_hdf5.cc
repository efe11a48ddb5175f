#include "experiments/real/sequences/posebench_file.h"
#include "parameters/input_error.h"

namespace rcme {

struct PosebenchFile::Handle {};

PosebenchFile::PosebenchFile(const std::string&) {
  throw InputError(
      "--layout posebench: this program was built without HDF5; install libhdf5-dev and build it again");
}
PosebenchFile::~PosebenchFile() = default;
std::vector<std::string> PosebenchFile::ListGroups() const { return {}; }
StoredPair PosebenchFile::ReadGroup(const std::string&) const { return {}; }

}  // namespace rcme
