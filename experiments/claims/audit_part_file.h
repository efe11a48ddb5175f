// The file of one shard's part of an audit (JSON): what was decided, every number to its last bit, and of
// which audit it is.
#pragma once

#include <map>
#include <string>

#include "experiments/claims/audit.h"
#include "experiments/study/run_description.h"
#include "experiments/study/shard.h"

namespace rcme {

struct AuditPart {
  std::string identity;  // equal for the parts of one audit, a line for each thing
  Shard shard;
  TrialOrigin origin;
  std::map<CheckPlace, CheckResult> results;  // of the checks that are decided
};

// Texts that are equal if and only if the results are, in every number; NaN has a sign.
std::string ResultAsText(const CheckResult& result);

std::string PartAsJson(const AuditPart& part);

// Throws InputError that names the path for a file that is no part of an audit, or not a whole one.
AuditPart ReadAuditPart(const std::string& path);

}  // namespace rcme
