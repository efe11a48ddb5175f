#include "experiments/statistics/truth_quality.h"

#include <fmt/format.h>

#include <cstdlib>
#include <string_view>

#include "parameters/text_lines.h"

namespace rcme {

namespace {

// Returns the number that follows these words; 0 if they do not occur.
long long NumberAfter(const std::string& line, std::string_view words) {
  const size_t at = line.find(words);
  return at == std::string::npos ? 0 : std::atoll(line.c_str() + at + words.size());
}

// Describes the number of pairs whose truth is listed as in doubt.
std::string DescribeDoubts(long long num_in_doubt, long long num_pairs) {
  if (num_in_doubt == 0) return {};
  return fmt::format("\nThe truth of {} of {} pairs is in doubt (truth_in_doubt): they are not scored.",
                     num_in_doubt, num_pairs);
}

}  // namespace

std::string DescribeTruthQuality(const std::string& identity) {
  long long num_pairs = 0, num_stated = 0, num_assumed = 0, num_in_doubt = 0;
  for (const std::string& line : SplitText(identity, '\n')) {  // as match_folder.cc writes them
    long long condition = 0, pairs = 0, stated = 0;
    unsigned long long digest = 0;
    const int num_read =
        std::sscanf(line.c_str(), "# condition %lld: %lld files, digest %llx, truth_sd in %lld", &condition,
                    &pairs, &digest, &stated);
    if (num_read < 3) continue;
    num_pairs += pairs;
    num_stated += stated;
    num_assumed += NumberAfter(line, ", truth_sd assumed in ");
    num_in_doubt += NumberAfter(line, ", truth in doubt in ");
  }
  if (num_pairs == 0) return {};
  const std::string doubts = DescribeDoubts(num_in_doubt, num_pairs);
  if (num_stated == num_pairs)
    return fmt::format(
        "Truth: all {} pairs state its own error (truth_sd), which is part of NEES and coverage.{}",
        num_pairs, doubts);
  if (num_stated + num_assumed == num_pairs)
    return fmt::format(
        "Truth: its own error, part of NEES and coverage, is the study's assumption for {} of {} pairs "
        "(truth_rotation_sd_deg,\n"
        "truth_position_sd), not their files' statement (truth_sd).{}",
        num_assumed, num_pairs, doubts);
  return fmt::format(
      "Truth: how good it is, {} of {} pairs do not say (no truth_sd); there NEES and coverage take it as "
      "exact\n"
      "and count its error as the estimator's.{}",
      num_pairs - num_stated - num_assumed, num_pairs, doubts);
}

}  // namespace rcme
