#include "experiments/statistics/truth_quality.h"

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "parameters/text_lines.h"

namespace rcme {

std::string DescribeTruthQuality(const std::string& identity) {
  long long num_pairs = 0, num_stated = 0, num_assumed = 0;
  for (const std::string& line : SplitText(identity, '\n')) {  // as match_folder.cc writes them
    long long condition = 0, pairs = 0, stated = 0;
    unsigned long long digest = 0;
    const int num_read =
        std::sscanf(line.c_str(), "# condition %lld: %lld files, digest %llx, truth_sd in %lld", &condition,
                    &pairs, &digest, &stated);
    if (num_read < 3) continue;
    num_pairs += pairs;
    num_stated += stated;
    constexpr std::string_view kAssumed = ", truth_sd assumed in ";
    const size_t assumed = line.find(kAssumed);
    if (assumed != std::string::npos) num_assumed += std::atoll(line.c_str() + assumed + kAssumed.size());
  }
  if (num_pairs == 0) return {};
  if (num_stated == num_pairs)
    return fmt::format(
        "Truth: all {} pairs state its own error (truth_sd), which is part of NEES and coverage.", num_pairs);
  if (num_stated + num_assumed == num_pairs)
    return fmt::format(
        "Truth: its own error, part of NEES and coverage, is the study's assumption for {} of {} pairs "
        "(truth_rotation_sd_deg,\n"
        "truth_position_sd), not their files' statement (truth_sd).",
        num_assumed, num_pairs);
  return fmt::format(
      "Truth: how good it is, {} of {} pairs do not say (no truth_sd); there NEES and coverage take it as "
      "exact\n"
      "and count its error as the estimator's.",
      num_pairs - num_stated - num_assumed, num_pairs);
}

}  // namespace rcme
