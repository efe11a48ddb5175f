#pragma once

#include <string>

#include "experiments/audit/claims/audit.h"

namespace rcme {

// The audit as a page of Markdown: the table of verdicts, then for each family its figure, its sentences and
// every measured number.
std::string AuditAsMarkdown(const Audit& audit);

}  // namespace rcme
