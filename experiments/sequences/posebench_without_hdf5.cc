#include "experiments/sequences/listed_pairs.h"
#include "parameters/input_error.h"

namespace rcme {

std::unique_ptr<ListedPairs> OpenPosebench(const DatasetOptions&) {
  throw InputError(
      "--layout posebench: this program was built without HDF5; install libhdf5-dev and build it again");
}

}  // namespace rcme
