#include "experiments/run/refusal_watch.h"

#include <fmt/format.h>

#include "experiments/core/text/message.h"

namespace rcme {

void RefusalWatch::Add(const std::vector<TrialRecord>& records) {
  const std::lock_guard lock(mutex_);
  ++num_trials_;
  refusals_.resize(records.size());
  for (size_t e = 0; e < records.size(); ++e) {
    if (HasRefused(records[e])) ++refusals_[e][records[e].status];
  }
}

void RefusalWatch::WarnOfRefusals(const std::vector<EstimatorSpec>& estimators) const {
  const std::lock_guard lock(mutex_);
  for (size_t e = 0; e < refusals_.size(); ++e) {
    std::int64_t num_refused = 0;
    std::vector<std::string> counts;
    for (const auto& [status, count] : refusals_[e]) {
      num_refused += count;
      counts.push_back(fmt::format("{} {}", StatusName(status), count));
    }
    if (num_refused < num_trials_) continue;
    PrintMessage(
        "warning: {} refused every one of the {} trials run now ({}); rcme replay FILE --condition 0 --trial "
        "0 "
        "shows why\n",
        estimators.at(e).label, num_trials_, fmt::join(counts, ", "));
  }
}

}  // namespace rcme
