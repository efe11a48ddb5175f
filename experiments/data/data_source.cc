#include "experiments/data/data_source.h"

namespace rcme {

RandomStream StreamFor(StreamName trial_name, StreamPurpose purpose) {
  trial_name.purpose = static_cast<std::uint32_t>(purpose);
  return RandomStream(trial_name);
}

}  // namespace rcme
