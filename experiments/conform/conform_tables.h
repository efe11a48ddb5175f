// The measures of a conform report, and its tables: regions, accepted answers and probabilities.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiments/conform/conform_report.h"
#include "experiments/conform/cross_validate.h"
#include "experiments/core/table/table.h"

namespace rcme {

// Upper limit of a region's size, deg: the region has all motions.
inline constexpr double kWholeSpaceDeg = 180.0;

// One of the regions that a report compares: the stated one, the conformed one and baselines. A region around
// each answer is an ellipsoid of the scaled stated covariance, or a ball.
struct RegionKind {
  std::string name;
  std::function<bool(const JudgedAnswer&)> covers;
  std::function<double(const JudgedAnswer&)> size_deg;  // geometric mean of the semi-axes
};

// "stated" first and "conformed" last. A check has these two only; a calibration has baselines between them.
std::vector<RegionKind> ListRegionKinds(bool is_check);

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
