// CRC-32 over what a result file holds. It finds accidents: every flip of one bit of a number or a text, any
// other change with probability 1 - 2^-32. It is no signature: who changes a file on purpose can compute it
// again.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "experiments/trial/trial.h"

namespace rcme {

// Of some texts in order; where one ends and the next begins counts.
std::uint32_t ChecksumOf(const std::vector<std::string>& texts);

// Of all fields of one trial's records, the wall times included: what is stored is protected, whether or not
// it can be computed again. `identity` is the checksum of the study's identity: a trial of another study does
// not pass.
std::uint32_t ChecksumOfTrial(std::uint32_t identity, const ProblemRecord& problem,
                              std::span<const TrialRecord> records);

}  // namespace rcme
