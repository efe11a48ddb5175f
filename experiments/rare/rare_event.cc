#include "experiments/rare/rare_event.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimator/protection_level.h"
#include "stats/constants.h"

namespace rcme {
namespace {

// The event decides on which side of 1 the result lies, because the quotient is rounded, and 0 / 0 if a bound
// is 0.
double DecideQuotient(double quotient, bool has_happened) {
  return has_happened ? std::fmax(quotient, std::nextafter(1.0, 2.0)) : std::fmin(quotient, 1.0);
}

}  // namespace

const char* Name(RareEvent::Kind kind) {
  switch (kind) {
    case RareEvent::Kind::kFailure:
      return "failure";
    case RareEvent::Kind::kMisleadingRotation:
      return "misleading_rotation";
    case RareEvent::Kind::kMisleadingDirection:
      break;
  }
  return "misleading_direction";
}

double ErrorOverBound(const TrialRecord& record, const FailureBounds& bounds) {
  if (IsInvalid(record)) return std::numeric_limits<double>::infinity();
  if (HasRefused(record)) return 0.0;
  const double rotation = record.rotation_error_deg / bounds.max_rotation_error_deg;
  const double direction = record.direction_error_deg / bounds.max_direction_error_deg;
  return DecideQuotient(std::isnan(direction) ? rotation : std::max(rotation, direction),
                        HasFailed(record, bounds));
}

double ErrorOverLevel(const MotionEstimate& estimate, const TrialRecord& record, const RareEvent& event) {
  if (record.status != MotionStatus::kOk) return 0.0;
  const bool is_rotation = event.kind == RareEvent::Kind::kMisleadingRotation;
  const double error_deg = is_rotation ? record.rotation_error_deg : record.direction_error_deg;
  if (std::isnan(error_deg)) return 0.0;
  const ProtectionLevels levels = ComputeProtectionLevels(estimate, event.risk);
  const double level_deg = kDegPerRad * (is_rotation ? levels.rotation_rad : levels.direction_rad);
  return DecideQuotient(error_deg / level_deg, error_deg > level_deg);
}

double ComputeNearness(const MotionEstimate& estimate, const TrialRecord& record, const RareEvent& event,
                       const FailureBounds& bounds) {
  return event.kind == RareEvent::Kind::kFailure ? ErrorOverBound(record, bounds)
                                                 : ErrorOverLevel(estimate, record, event);
}

}  // namespace rcme
