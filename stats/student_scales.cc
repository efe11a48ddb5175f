#include "stats/student_scales.h"

#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

namespace rcme {
namespace {

constexpr int kNumScales = 32;

}  // namespace

StudentScales::StudentScales(double degrees_of_freedom) {
  if (degrees_of_freedom == 0.0) {
    scales_ = {1.0};
    return;
  }
  double sum_squares = 0.0;
  for (int k = 0; k < kNumScales; ++k) {
    const double chi_square =
        2.0 * boost::math::gamma_p_inv(0.5 * degrees_of_freedom, (k + 0.5) / kNumScales);
    scales_.push_back(std::sqrt(degrees_of_freedom / chi_square));
    sum_squares += degrees_of_freedom / chi_square;
  }
  for (double& scale : scales_) scale = 1e-6 * std::round(1e6 * scale / std::sqrt(sum_squares / kNumScales));
}

double StudentScales::Draw(RandomStream& rng) const {
  if (scales_.size() == 1) return scales_.front();
  return scales_[rng.IntegerBelow(static_cast<std::uint32_t>(scales_.size()))];
}

}  // namespace rcme
