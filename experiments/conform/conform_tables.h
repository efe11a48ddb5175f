// The measures of a conform report, and its tables: regions, accepted answers and probabilities.
#pragma once

#include <functional>
#include <vector>

#include "experiments/conform/conform_report.h"
#include "experiments/conform/region_kinds.h"
#include "experiments/core/table/table.h"

namespace rcme {

// The share of answers for which `holds` is true, with an interval by groups. `more`: the groups of further
// problems, which count as false.
Estimate MeasureShare(const std::vector<JudgedAnswer>& judged,
                      const std::function<bool(const JudgedAnswer&)>& holds,
                      const std::vector<std::int64_t>& more = {});

double MeasureMedianSize(const std::vector<JudgedAnswer>& judged, const RegionKind& kind);

// The number of answers that count as the hardest quarter.
size_t CountHardest(const std::vector<JudgedAnswer>& judged);

bool IsAcceptedByRule(const JudgedAnswer& answer);

// A share of all problems, refused ones included, as in the promise.
Estimate MeasureWrongAndAccepted(const ConformReport& report,
                                 const std::function<bool(const JudgedAnswer&)>& accepts);

Table MakeRegionTable(const ConformReport& report);
Table MakeAcceptTable(const ConformReport& report);
Table MakeProbabilityTable(const ConformReport& report);

}  // namespace rcme
