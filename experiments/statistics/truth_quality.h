#pragma once

#include <string>

namespace rcme {

// Describes the quality of the truth of a run's pairs, from its identity (study_plan.h): how many pairs
// state the uncertainty of their truth (truth_sd, match_file.h), and how many are listed as in doubt
// (truth_doubts.h). Empty if no pair is real, because the truth of a simulation is exact.
std::string DescribeTruthQuality(const std::string& identity);

}  // namespace rcme
