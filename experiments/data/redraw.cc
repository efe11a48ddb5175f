#include "experiments/data/redraw.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "estimator/geometry/essential_matrix.h"
#include "estimator/geometry/sampson.h"
#include "parameters/input_error.h"
#include "simulator/noise/noise_laws.h"
#include "stats/constants.h"

namespace rcme {
namespace {

// Side of the mosaic (simulator/noise/correlated.cc) whose cells near neighbours share: at a distance of 1
// px half of the correlation is left.
constexpr double kNearLengthPx = 2.3;

// The greatest number of draws for a right match whose noise is too large, or for a wrong match that came
// too near.
constexpr int kMostDraws = 100;

Eigen::Matrix3d TrueFundamental(const TrialData& exact) {
  return FundamentalFromEssential(EssentialFromPose(*exact.truth.cam2_from_cam1_true), exact.problem.camera1,
                                  exact.problem.camera2);
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
                      "new noise of the matches that satisfy the true motion (rcme twin); 0: the files' own"),
      Parameter::Real("redraw_student_dof", &s.student_dof, {0.0, 1000.0}, "",
                      "degrees of freedom of its Student's t in 32 steps, common to a match; 0: normal"),
      Parameter::Real("redraw_within_px", &s.within_px, {0.0, 1000.0}, "px",
                      "right matches farther from their epipolar line get new noise, wrong ones nearer are "
                      "exchanged; 0: never"),
      Parameter::Real("redraw_near_share", &s.near_share, {0.0, 1.0}, "",
                      "share of its variance common within 1 or 2 px"),
      Parameter::Real("redraw_far_share", &s.far_share, {0.0, 1.0}, "",
                      "share of its variance common within redraw_far_length_px"),
      Parameter::Real("redraw_far_length_px", &s.far_length_px, {0.01, 1e5}, "px",
                      "distance at which that correlation is 0.045 of its greatest"),
      Parameter::Choice<WrongMatches>("redraw_wrong", &s.wrong,
                                      {{"kept", WrongMatches::kKept}, {"shuffled", WrongMatches::kShuffled}},
                                      "the other matches: as they are, or with second points shuffled")};
}

Redraw::Redraw(const RedrawSettings& settings) : settings_(settings), scales_(settings.student_dof) {
  if (!IsOn()) return;
  const double own_share = 1.0 - settings.near_share - settings.far_share;
  if (own_share < -1e-9) {
    throw InputError(fmt::format("redraw_near_share: {} and redraw_far_share: {} are together more than 1",
                                 settings.near_share, settings.far_share));
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
  const Eigen::Matrix3d F = TrueFundamental(*exact);
  exact->truth.is_inlier_true.clear();
  for (const Correspondence& match : problem.matches)
    exact->truth.is_inlier_true.push_back(SquaredSampsonDistance(F, match) < kExactPx * kExactPx);
}

// Each law uses the exact positions, not those changed by another law. A scale that moves a match too far is
// drawn again; if all do, the match keeps its position.
std::vector<Correspondence> Redraw::WithNoise(const TrialData& exact, const std::vector<size_t>& right,
                                              double noise_level, RandomStream& rng) const {
  std::vector<Correspondence> places, noisy;
  for (const size_t i : right) places.push_back(exact.problem.matches[i]);
  std::vector<Eigen::Vector4d> noise(right.size(), Eigen::Vector4d::Zero());
  for (const auto& law : laws_) {
    std::vector<Correspondence> moved = places;
    law->AddTo(moved, rng);
    for (size_t k = 0; k < right.size(); ++k) {
      noise[k].head<2>() += moved[k].x1_px - places[k].x1_px;
      noise[k].tail<2>() += moved[k].x2_px - places[k].x2_px;
    }
  }
  const Eigen::Matrix3d F = TrueFundamental(exact);
  const double farthest = settings_.within_px > 0.0 ? noise_level * settings_.within_px : kInfinity;
  for (size_t k = 0; k < right.size(); ++k) {
    const double own =
        noise_level * (exact.problem.noise_scale.empty() ? 1.0 : exact.problem.noise_scale[right[k]]);
    Correspondence drawn = places[k];
    for (int draw = 0; draw < kMostDraws; ++draw) {
      const double scale = own * scales_.Draw(rng);
      drawn.x1_px = places[k].x1_px + scale * noise[k].head<2>();
      drawn.x2_px = places[k].x2_px + scale * noise[k].tail<2>();
      if (SquaredSampsonDistance(F, drawn) <= farthest * farthest) break;
      drawn = places[k];
    }
    noisy.push_back(drawn);
  }
  return noisy;
}

void Redraw::DealOutAgain(const TrialData& exact, const std::vector<size_t>& wrong, double noise_level,
                          RandomStream& rng, std::vector<Correspondence>* matches) const {
  std::vector<Eigen::Vector2d> second_points;
  for (const size_t i : wrong) second_points.push_back((*matches)[i].x2_px);
  rng.Shuffle(std::span(second_points));
  for (size_t k = 0; k < wrong.size(); ++k) (*matches)[wrong[k]].x2_px = second_points[k];
  if (!(settings_.within_px > 0.0)) return;
  const Eigen::Matrix3d F = TrueFundamental(exact);
  const double near_px = noise_level * settings_.within_px;
  const auto is_near = [&](size_t i) {
    return SquaredSampsonDistance(F, (*matches)[i]) <= near_px * near_px;
  };
  for (const size_t i : wrong) {
    for (int draw = 0; draw < kMostDraws && is_near(i); ++draw) {
      const size_t other = wrong[rng.IntegerBelow(static_cast<std::uint32_t>(wrong.size()))];
      std::swap((*matches)[i].x2_px, (*matches)[other].x2_px);
      if (is_near(other)) std::swap((*matches)[i].x2_px, (*matches)[other].x2_px);
    }
  }
}

TrialData Redraw::Draw(const TrialData& exact, const StreamName& trial_name, double noise_level) const {
  TrialData drawn = exact;
  std::vector<size_t> right, wrong;
  for (size_t i = 0; i < exact.problem.matches.size(); ++i)
    (exact.truth.is_inlier_true[i] ? right : wrong).push_back(i);
  RandomStream noise_rng = StreamFor(trial_name, StreamPurpose::kNoise),
               wrong_rng = StreamFor(trial_name, StreamPurpose::kOutliers);
  const std::vector<Correspondence> noisy = WithNoise(exact, right, noise_level, noise_rng);
  for (size_t k = 0; k < right.size(); ++k) drawn.problem.matches[right[k]] = noisy[k];
  if (settings_.wrong == WrongMatches::kShuffled)
    DealOutAgain(exact, wrong, noise_level, wrong_rng, &drawn.problem.matches);
  return drawn;
}

}  // namespace rcme
