// The result of a check as the part of a shard keeps it (pieces/part_file.h), every number to its last bit.
#pragma once

#include <string>

#include "experiments/claims/claim_verdict.h"

namespace rcme {

// Texts that are equal if and only if the results are, in every number.
std::string ResultAsJson(const CheckResult& result);

// Throws std::exception for a text that is no such result.
CheckResult ResultFrom(const std::string& text);

}  // namespace rcme
