#include "experiments/analysis/truth_quality.h"

#include <fmt/format.h>

#include <cstdio>
#include <sstream>

namespace rcme {

std::string TruthQualityInWords(const std::string& identity) {
  long long num_pairs = 0, num_stated = 0;
  std::istringstream lines(identity);
  for (std::string line; std::getline(lines, line);) {  // as match_folder.cc writes them
    long long condition = 0, pairs = 0, stated = 0;
    unsigned long long digest = 0;
    const int num_read =
        std::sscanf(line.c_str(), "# condition %lld: %lld files, digest %llx, truth_sd in %lld", &condition,
                    &pairs, &digest, &stated);
    if (num_read < 3) continue;
    num_pairs += pairs;
    num_stated += stated;
  }
  if (num_pairs == 0) return {};
  if (num_stated == num_pairs)
    return fmt::format(
        "Truth: all {} pairs state its own error (truth_sd), which is part of NEES and coverage.", num_pairs);
  return fmt::format(
      "Truth: how good it is, {} of {} pairs do not say (no truth_sd); there NEES and coverage take it as "
      "exact\n"
      "and count its error as the estimator's.",
      num_pairs - num_stated, num_pairs);
}

}  // namespace rcme
