#include "experiments/ask/inlier_threshold.h"

#include <fmt/format.h>

#include <cmath>

#include "parameters/parameter.h"
#include "parameters/settings.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

// MSAC compares the squared Sampson distance with sigma^2 chi2_1 (estimator/point_consistency.h).
std::string DescribeSampson(double level, double sigma_px) {
  const double num_sigma = std::sqrt(ChiSquareQuantile(1, 1.0 - level));
  return fmt::format("{:.3g} px of Sampson distance ({:.3g} sigma: keeps {:g} % of the true matches)",
                     num_sigma * sigma_px, num_sigma, 100.0 * (1.0 - level));
}

// RCME's test widens with the uncertainty of each hypothesis.
std::string DescribeTestOfHypothesis(double level, double sigma_px) {
  return fmt::format(
      "none in px: a test that keeps {:g} % of the true matches, given sigma = {:g} px and each hypothesis' "
      "covariance",
      100.0 * (1.0 - level), sigma_px);
}

std::string DescribeCalibrated(const std::string& sigma, double sigma_px) {
  const std::string known = sigma == "estimated" ? fmt::format("estimated, from {:g} px on", sigma_px)
                                                 : fmt::format("taken as {:g} px", sigma_px);
  return fmt::format("none: each match has a weight, by its distance and by sigma ({})", known);
}

}  // namespace

std::string DescribeInlierThreshold(const std::string& name, const Settings& options, double sigma_px) {
  if (name == "rcme_calibrated")
    return DescribeCalibrated(FindSetting(options, "sigma").value_or(""), sigma_px);
  double level = 0.0, num_sigma = 0.0;
  const bool has_level = ParseReal(FindSetting(options, "significance_level").value_or(""), &level);
  const bool has_sigma = ParseReal(FindSetting(options, "threshold_sigma").value_or(""), &num_sigma);
  if (name == "msac" && has_level) return DescribeSampson(level, sigma_px);
  if (name == "rcme" && has_level) return DescribeTestOfHypothesis(level, sigma_px);
  if (name == "opencv_usac" && has_sigma) {
    // OpenCV's distance has the standard deviation 2 sigma (peers/opencv_usac.cc).
    return fmt::format("{:.3g} px as OpenCV takes it ({:g} standard deviations of its distance)",
                       2.0 * num_sigma * sigma_px, num_sigma);
  }
  if (name == "opengv_ransac" && has_sigma)
    return fmt::format("{:.3g} px of reprojection error in both images together ({:g} sigma)",
                       num_sigma * sigma_px, num_sigma);
  return {};
}

}  // namespace rcme
