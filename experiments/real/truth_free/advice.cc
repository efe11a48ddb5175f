#include "experiments/real/truth_free/advice.h"

#include <fmt/format.h>

#include <algorithm>

namespace rcme {
namespace {

const TruthFreeTest& Named(const SetReport& report, const std::string& name) {
  return *std::ranges::find(report.tests, name, &TruthFreeTest::name);
}

}  // namespace

std::vector<std::string> FindReasons(const SetReport& report) {
  std::vector<std::string> advice;
  const auto is_small = [&](const char* name) {
    return Named(report, name).verdict == TruthFreeVerdict::kTooSmall;
  };
  const bool is_correlated_far = std::ranges::any_of(report.correlations, [](const DistanceCorrelation& c) {
    return c.from_px >= 1.0 && c.difference.lower > kNominalCorrelation;
  });
  if (is_small("random_halves"))
    advice.emplace_back(
        "random halves differ more than independent errors explain: wrong matches among the inliers, or an "
        "assumed "
        "sigma that is too small (an estimator that estimates it)");
  if (report.correlations.front().difference.lower > kNominalCorrelation)
    advice.emplace_back("points within 1 px of each other err alike: one point found twice");
  if (is_correlated_far) advice.emplace_back("neighbours err alike");
  if (is_small("spatial_halves") && !is_small("random_halves") && !is_correlated_far)
    advice.emplace_back(
        "halves of the image disagree, with no correlation up to 64 px: look at calibration, distortion, "
        "rolling shutter (focal_sd, principal_point_sd_px, distortion_sd)");
  if (const TruthFreeTest& own = Named(report, kSimulationTest);
      own.verdict == TruthFreeVerdict::kTooSmall || own.verdict == TruthFreeVerdict::kTooLarge)
    advice.push_back(fmt::format(
        "the estimator's own covariance is {} by {:.2g} in variance where errors are independent and normal",
        VerdictName(own.verdict),
        own.verdict == TruthFreeVerdict::kTooSmall ? own.ratio.value : 1.0 / own.ratio.value));
  if (Named(report, "random_halves").verdict == TruthFreeVerdict::kTooLarge &&
      Named(report, "spatial_halves").verdict != TruthFreeVerdict::kTooLarge)
    advice.emplace_back(
        "random halves differ less than the covariances say, halves of the image do not: what neighbours' "
        "errors have "
        "in common is in both random halves and cancels; no reason to narrow the covariances");
  if (is_small("closure"))
    advice.push_back(
        fmt::format("rotations around loops of images do not close: too small by {:.2g} in variance; if "
                    "halves hold, an error that is common to a whole image, as of its calibration",
                    Named(report, "closure").ratio.value));
  if (is_small("directions") && !is_small("closure"))
    advice.emplace_back(
        "directions of translation around three images do not lie in a plane, though rotations close: "
        "directions are less certain than stated");
  if (report.sizes.verdict == TruthFreeVerdict::kTooSmall ||
      report.sizes.verdict == TruthFreeVerdict::kTooLarge)
    advice.push_back(
        fmt::format("the noise {} between matches: take sigma_px to the power {:.2g}, or one noise for all",
                    DescribeSizeTest(report.sizes), report.sizes.slope.value));
  return advice;
}

}  // namespace rcme
