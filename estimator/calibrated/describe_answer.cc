#include "estimator/calibrated/describe_answer.h"

#include <fmt/format.h>

#include <cmath>

#include "parameters/probability_text.h"

namespace rcme {
namespace {

constexpr double kLowDepth = 6.0;        // standard deviations of the parallax's noise
constexpr double kRandomPartners = 2.0;  // standard deviations

Doubt DoubtOfOrigin(const ExplainedMode& mode, bool is_second_motion) {
  if (is_second_motion) return Doubt::kOtherMotion;
  switch (mode.mode.origin) {
    case ModeOrigin::kTwistedPair:
      return Doubt::kPlane;
    case ModeOrigin::kLeverage:
      return Doubt::kFewMatchesDecide;
    case ModeOrigin::kOppositeWay:
      return Doubt::kOppositeWay;
    case ModeOrigin::kSample:
      break;
  }
  return Doubt::kOtherMotion;
}

}  // namespace

Doubt FindDoubt(const std::vector<ExplainedMode>& modes, const ModeWeights& weights,
                const ModesVerdict& verdict) {
  Doubt doubt = Doubt::kNone;
  double greatest = 0.01;
  const auto consider = [&](double part, Doubt reason) {
    if (part > greatest) greatest = part, doubt = reason;
  };
  // If the check lowers the probability, all parts are lowered in proportion.
  const double share =
      verdict.failure_probability < verdict.by_modes ? verdict.failure_probability / verdict.by_modes : 1.0;
  // 1 - P is the probability by modes and check times what uncertain intrinsics leave of it.
  const double right = 1.0 - verdict.failure_probability;
  const double by_intrinsics = right / verdict.left_by_intrinsics - right;
  consider(share * verdict.mass_beyond + by_intrinsics, Doubt::kLowParallax);
  consider(verdict.failure_probability - by_intrinsics - verdict.by_modes, Doubt::kModel);
  consider(share * weights.of_no_motion, Doubt::kFewMatches);
  for (size_t i = 0; i < modes.size(); ++i) {
    if (weights.is_rival[i])
      consider(share * weights.of_modes[i], DoubtOfOrigin(modes[i], weights.is_second_motion[i]));
  }
  return doubt;
}

namespace {

// Names the first indicator of the check that is out of its usual range.
std::string ModelDoubt(const ModelCheck& check) {
  const double noise = std::exp(check.log_noise_ratio);
  if (check.partner_dependence.greater_z() < kRandomPartners)
    return ": along the epipolar lines the matches lie as random ones would";
  if (check.neighbour_z > 5.0) return ": neighbouring matches err alike";
  if (noise > 1.25 || noise < 0.8) return fmt::format(": the noise is {:.2g} times the assumed", noise);
  if (check.wrong_share > 0.1 && check.wrong_coherence > 0.5) return ": wrong matches move together";
  if (check.log_parallax_share < std::log(0.25)) return ": a small part of the image holds the parallax";
  if (check.planar_share > 0.9) return ": a plane explains nearly all matches";
  return ": motions from matches like these fail that often";
}

std::string OtherMotion(const MotionEstimate& e) {
  const double share = e.other_modes.empty() ? 0.0 : e.other_modes.front().explained_share;
  if (share < 0.005) return ": another motion explains the matches as well";
  return fmt::format(": another motion explains {:.0f} % more of the matches", 100.0 * share);
}

std::string DescribeReason(const MotionEstimate& e, const ModelCheck& check) {
  switch (e.doubt) {
    case Doubt::kNone:
      return {};
    case Doubt::kOtherMotion:
      return OtherMotion(e);
    case Doubt::kPlane:
      return ": a plane, two motions explain the matches";
    case Doubt::kFewMatchesDecide:
      return ": a few matches of large influence decide";
    case Doubt::kOppositeWay:
      return ": the direction may be the opposite one";
    case Doubt::kLowParallax:
      return check.usual_depth < kLowDepth ? ": hardly any parallax, the direction is poorly determined"
                                           : ": the direction is poorly determined";
    case Doubt::kFewMatches:
      return ": chance might explain as many matches";
    case Doubt::kModel:
      return ModelDoubt(check);
  }
  return {};
}

}  // namespace

std::string DescribeAnswer(const MotionEstimate& e, double sigma_px, const ModelCheck& check) {
  return fmt::format("{} of {} matches agree, sigma {:.2g} px; wrong with probability {}{}", e.inliers.size(),
                     e.inlier_probabilities.size(), sigma_px, ProbabilityText(e.failure_probability),
                     DescribeReason(e, check));
}

}  // namespace rcme
