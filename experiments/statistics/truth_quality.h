#pragma once

#include <string>

namespace rcme {

// What a run's identity (study_plan.h) says of how good the truth of its pairs is, in words: how many of them
// state it (truth_sd, match_file.h), and how many are listed as in doubt (truth_doubts.h). Empty where no pair is real: the truth of a simulation is exact.
std::string DescribeTruthQuality(const std::string& identity);

}  // namespace rcme
