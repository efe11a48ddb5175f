#include "experiments/data/redraw.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "estimator/geometry/essential_matrix.h"
#include "estimator/geometry/sampson.h"
#include "parameters/input_error.h"
#include "simulator/noise/noise_laws.h"

namespace rcme {
namespace {

// Side of the mosaic (simulator/noise/correlated.cc) whose cells near neighbours share: half of the
// correlation is left at 1 px.
constexpr double kNearLengthPx = 2.3;

// Root of (m - 2) / chi-square with m degrees of freedom: times a standard normal number it is Student's t,
// scaled to variance one.
double StudentScale(int degrees_of_freedom, RandomStream& rng) {
  double chi_square = 0.0;
  for (int k = 0; k < degrees_of_freedom; ++k) {
    const double z = rng.Normal();
    chi_square += z * z;
  }
  return std::sqrt((degrees_of_freedom - 2.0) / chi_square);
}

std::shared_ptr<const NoiseModel> ConfiguredNoise(std::unique_ptr<NoiseModel> law,
                                                  const std::vector<std::pair<std::string, double>>& values) {
  for (const Parameter& parameter : law->Parameters()) {
    for (const auto& [name, value] : values) {
      if (parameter.name() == name) parameter.SetFromText(fmt::format("{}", value));
    }
  }
  return law;
}

std::shared_ptr<const NoiseModel> SharedNoise(double sigma_px, double length_px) {
  return ConfiguredNoise(
      MakeCorrelatedNoise(),
      {{"sigma_px", sigma_px}, {"noise_correlation", 1.0}, {"noise_correlation_length_px", length_px}});
}

}  // namespace

std::vector<Parameter> Parameters(RedrawSettings& s) {
  return {
      Parameter::Real("redraw_noise_px", &s.noise_px, {0.0, 1000.0}, "px",
                      "0: matches as the files have them; else those that satisfy the file's true motion get "
                      "noise of this standard deviation (rcme twin writes such files)"),
      Parameter::Integer(
          "redraw_student_dof", &s.student_dof, {0, 1000},
          "degrees of freedom of Student's t, the law of that noise, large for all of a match at "
          "once; 0: normal"),
      Parameter::Real("redraw_near_share", &s.near_share, {0.0, 1.0}, "",
                      "share of its variance that key points within 1 or 2 px have in common"),
      Parameter::Real("redraw_far_share", &s.far_share, {0.0, 1.0}, "",
                      "share of its variance that key points within redraw_far_length_px have in common"),
      Parameter::Real("redraw_far_length_px", &s.far_length_px, {0.01, 1e5}, "px",
                      "distance at which that correlation has fallen to 0.045 of its greatest"),
      Parameter::Choice<WrongMatches>(
          "redraw_wrong", &s.wrong, {{"kept", WrongMatches::kKept}, {"shuffled", WrongMatches::kShuffled}},
          "the other matches: as they are, or their second points dealt out again among them")};
}

Redraw::Redraw(const RedrawSettings& settings) : settings_(settings) {
  if (!IsOn()) return;
  const double own_share = 1.0 - settings.near_share - settings.far_share;
  if (own_share < -1e-9) {
    throw InputError(fmt::format("redraw_near_share: {} and redraw_far_share: {} are together more than 1",
                                 settings.near_share, settings.far_share));
  }
  if (settings.student_dof == 1 || settings.student_dof == 2) {
    throw InputError(fmt::format("redraw_student_dof: {} has no variance; give 0 (normal) or 3 and more",
                                 settings.student_dof));
  }
  const auto sigma_of = [&](double share) { return settings.noise_px * std::sqrt(share); };
  if (settings.near_share > 0.0) laws_.push_back(SharedNoise(sigma_of(settings.near_share), kNearLengthPx));
  if (settings.far_share > 0.0)
    laws_.push_back(SharedNoise(sigma_of(settings.far_share), settings.far_length_px));
  if (own_share > 0.0) laws_.push_back(MakeGaussianNoise(sigma_of(own_share)));
}

void Redraw::Label(TrialData* exact) {
  if (!exact->truth.cam2_from_cam1_true) {
    throw InputError(
        fmt::format("redraw_noise_px: {} states no true motion; give pairs with R_rowmajor and "
                    "t_unit whose right matches satisfy it (rcme twin writes them)",
                    exact->origin));
  }
  const MotionProblem& problem = exact->problem;
  const Eigen::Matrix3d F = FundamentalFromEssential(EssentialFromPose(*exact->truth.cam2_from_cam1_true),
                                                     problem.camera1, problem.camera2);
  exact->truth.is_inlier_true.clear();
  for (const Correspondence& match : problem.matches)
    exact->truth.is_inlier_true.push_back(SquaredSampsonDistance(F, match) < kExactPx * kExactPx);
}

TrialData Redraw::Draw(const TrialData& exact, const StreamName& trial_name) const {
  TrialData drawn = exact;
  std::vector<Correspondence>& matches = drawn.problem.matches;
  const std::vector<bool>& is_right = drawn.truth.is_inlier_true;
  std::vector<Correspondence> right;
  std::vector<Eigen::Vector2d> second_points;  // of the wrong ones
  std::vector<double> right_scale;             // of their noise, where the pair states it
  for (size_t i = 0; i < matches.size(); ++i) {
    if (!is_right[i]) {
      second_points.push_back(matches[i].x2_px);
      continue;
    }
    right.push_back(matches[i]);
    if (!exact.problem.noise_scale.empty()) right_scale.push_back(exact.problem.noise_scale[i]);
  }
  RandomStream noise_rng = StreamFor(trial_name, StreamPurpose::kNoise),
               wrong_rng = StreamFor(trial_name, StreamPurpose::kOutliers);
  // Each law looks at where the exact points are, not at what another law has made of them.
  std::vector<Correspondence> noisy = right;
  for (const auto& law : laws_) {
    std::vector<Correspondence> moved = right;
    law->AddTo(moved, noise_rng);
    for (size_t k = 0; k < right.size(); ++k) {
      noisy[k].x1_px += moved[k].x1_px - right[k].x1_px;
      noisy[k].x2_px += moved[k].x2_px - right[k].x2_px;
    }
  }
  for (size_t k = 0; k < right.size(); ++k) {
    double scale = right_scale.empty() ? 1.0 : right_scale[k];
    if (settings_.student_dof > 0) scale *= StudentScale(settings_.student_dof, noise_rng);
    if (scale == 1.0) continue;
    noisy[k].x1_px = right[k].x1_px + scale * (noisy[k].x1_px - right[k].x1_px);
    noisy[k].x2_px = right[k].x2_px + scale * (noisy[k].x2_px - right[k].x2_px);
  }
  if (settings_.wrong == WrongMatches::kShuffled) wrong_rng.Shuffle(std::span(second_points));
  size_t num_right = 0, num_wrong = 0;
  for (size_t i = 0; i < matches.size(); ++i) {
    if (is_right[i])
      matches[i] = noisy[num_right++];
    else
      matches[i].x2_px = second_points[num_wrong++];
  }
  return drawn;
}

}  // namespace rcme
