#include "simulator/baseline_of_parallax.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rcme {
namespace {

constexpr double kTolerance = 1e-3;        // of the parallax, relative
constexpr double kNarrowest = 1.0 + 1e-5;  // the search ends at this ratio of its two baselines
constexpr double kLeast_m = 1e-9, kGreatest_m = 1e9;
constexpr int kMaxSteps = 200;

// Six digits, so that the result is the same on machines whose elementary functions differ in the last bits.
double Rounded(double x) {
  const double step = std::pow(10.0, std::floor(std::log10(x)) - 5.0);
  return step * std::round(x / step);
}

}  // namespace

BaselineSearch FindBaseline(const ParallaxOfBaseline& parallax_deg, double wanted_deg) {
  BaselineSearch search;
  double too_short = kLeast_m, too_long = std::numeric_limits<double>::infinity(), tried = kLeast_m;
  for (int step = 0; step < kMaxSteps && too_short < kGreatest_m && too_long > kNarrowest * too_short;
       ++step) {
    const std::optional<double> found = parallax_deg(tried);
    const double parallax = found.value_or(std::numeric_limits<double>::quiet_NaN());
    if (found) search.greatest_deg = std::max(search.greatest_deg, parallax);
    if (std::abs(parallax / wanted_deg - 1.0) <= kTolerance) {
      search.baseline_m = tried;
      return search;
    }
    if (parallax < wanted_deg) {
      too_short = tried;
    } else {
      too_long = tried;
    }
    // A step in proportion is about right, but must stay between the two baselines. Otherwise: twice the
    // shorter one if there is no longer one yet, else their geometric mean.
    const double in_proportion = tried * wanted_deg / parallax;
    const bool is_inside = in_proportion > too_short && in_proportion < too_long;
    tried = Rounded(is_inside              ? in_proportion
                    : std::isinf(too_long) ? 2.0 * too_short
                                           : std::sqrt(too_short * too_long));
  }
  return search;
}

}  // namespace rcme
