#pragma once

#include <string>

#include "experiments/audit/claims/audit.h"

namespace rcme {

// The audit as a page of Markdown: verdict table, and per family its figure, the sentences and every measured
// number.
std::string AuditAsMarkdown(const Audit& audit);

}  // namespace rcme
