#include "experiments/statistics/stated_sharpness.h"

#include <fmt/format.h>

#include <cmath>

namespace rcme {

bool StatedSharpness::IsKnown() const { return !std::isnan(sd_over_crb) || !std::isnan(rotation_sd_deg); }

void SharpnessMedians::Add(const TrialRecord& record) {
  const auto add = [](double value, StreamMedian* median) {
    if (!std::isnan(value)) median->Add(value);
  };
  add(record.density.sd_over_crb, &sd_over_crb_);
  add(record.density.rotation_sd_deg, &rotation_sd_deg_);
  add(record.density.direction_sd_deg, &direction_sd_deg_);
}

StatedSharpness SharpnessMedians::Measure() const {
  return {sd_over_crb_.median(), rotation_sd_deg_.median(), direction_sd_deg_.median()};
}

std::string DescribeSharpness(const StatedSharpness& sharpness) {
  if (!std::isnan(sharpness.sd_over_crb))
    return fmt::format("stated sd {:.3g} times the least possible", sharpness.sd_over_crb);
  if (std::isnan(sharpness.rotation_sd_deg)) return "";
  return fmt::format("stated sd {:.2g} deg of rotation, {:.2g} deg of direction", sharpness.rotation_sd_deg,
                     sharpness.direction_sd_deg);
}

}  // namespace rcme
