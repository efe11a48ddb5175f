#include "experiments/data/match_file_prior.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>

#include "stats/constants.h"

namespace rcme {
namespace {

double ReadPriorSd(const MatchHeader& header, const std::string& key, double sd_deg) {
  constexpr double kLeastDeg = 1e-4, kGreatestDeg = 180.0;
  if (!(sd_deg >= kLeastDeg && sd_deg <= kGreatestDeg))
    header.Fail(key, fmt::format("{} is not in [{:g}, {:g}] deg", sd_deg, kLeastDeg, kGreatestDeg));
  return kRadPerDeg * sd_deg;
}

RotationPrior ReadRotationPrior(const MatchHeader& header) {
  const std::string key = "prior_rotation_sd_deg";
  RotationPrior prior;
  prior.R = header.Rotation("prior_rotation_rowmajor");
  const size_t count = header.Has(key) ? SplitAtBlanks(header.Text(key)).size() : 3;
  if (count != 1 && count != 3) header.Fail(key, fmt::format("has {} numbers; give one or three", count));
  const bool is_one = count == 1;
  const std::vector<double> sd_deg = header.Numbers(key, count);
  for (int axis = 0; axis < 3; ++axis) {
    const double sd = ReadPriorSd(header, key, sd_deg[is_one ? 0 : static_cast<size_t>(axis)]);
    prior.cov(axis, axis) = sd * sd;
  }
  return prior;
}

}  // namespace

std::optional<MotionPrior> ReadPrior(const MatchHeader& header) {
  const auto has_any = [&](std::initializer_list<const char*> keys) {
    return std::ranges::any_of(keys, [&](const char* key) { return header.Has(key); });
  };
  MotionPrior prior;
  if (has_any({"prior_rotation_rowmajor", "prior_rotation_sd_deg"}))
    prior.rotation = ReadRotationPrior(header);
  if (has_any({"gravity1", "gravity2", "gravity_sd_deg"})) {
    const double sd = ReadPriorSd(header, "gravity_sd_deg", header.Numbers("gravity_sd_deg", 1).front());
    prior.gravity = {header.Direction("gravity1"), header.Direction("gravity2"), sd, sd};
  }
  if (has_any({"prior_direction", "prior_direction_sd_deg"})) {
    const double sd =
        ReadPriorSd(header, "prior_direction_sd_deg", header.Numbers("prior_direction_sd_deg", 1).front());
    prior.direction = {header.Direction("prior_direction"), sd};
  }
  if (CountPriorFreedom(prior) == 0) return std::nullopt;
  return prior;
}

std::string FormatPrior(const MotionPrior& prior) {
  const auto numbers = [](const Eigen::MatrixXd& values) {
    return fmt::format("{}", fmt::join(values.data(), values.data() + values.size(), " "));
  };
  std::string text;
  if (const std::optional<RotationPrior>& rotation = prior.rotation) {
    text += fmt::format("# prior_rotation_rowmajor: {}\n", numbers(rotation->R.transpose()));
    text += fmt::format("# prior_rotation_sd_deg: {}\n",
                        numbers(kDegPerRad * rotation->cov.diagonal().cwiseSqrt()));
  }
  if (const std::optional<GravityPrior>& gravity = prior.gravity) {
    text += fmt::format("# gravity1: {}\n# gravity2: {}\n# gravity_sd_deg: {}\n", numbers(gravity->in_cam1),
                        numbers(gravity->in_cam2),
                        kDegPerRad * std::hypot(gravity->sd1_rad, gravity->sd2_rad) / std::numbers::sqrt2);
  }
  if (const std::optional<DirectionPrior>& direction = prior.direction) {
    text += fmt::format("# prior_direction: {}\n# prior_direction_sd_deg: {}\n", numbers(direction->t),
                        kDegPerRad * direction->sd_rad);
  }
  return text;
}

}  // namespace rcme
