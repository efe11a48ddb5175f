#pragma once

#include <cstdint>
#include <span>

#include "experiments/trial/trial.h"

namespace rcme {

// CRC-32 of all fields of one trial's records, times included: it protects stored values whether or not they
// can be computed again. `identity` is the checksum of the study's identity, so a trial of another study has
// another checksum.
std::uint32_t ChecksumOfTrial(std::uint32_t identity, const ProblemRecord& problem,
                              std::span<const TrialRecord> records);

}  // namespace rcme
