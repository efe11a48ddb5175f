#pragma once

#include <cstdint>
#include <span>

#include "experiments/trial/trial.h"

namespace rcme {

// CRC-32 of all fields of one trial's records, the wall times included: what is stored is protected, whether or not
// it can be computed again. `identity` is the checksum of the study's identity: a trial of another study does
// not pass.
std::uint32_t ChecksumOfTrial(std::uint32_t identity, const ProblemRecord& problem,
                              std::span<const TrialRecord> records);

}  // namespace rcme
