#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "simulator/noise_model.h"
#include "stats/moments.h"
#include "stats/random.h"

namespace rcme {

constexpr double kNoiseZ = 3.89;  // two-sided false-alarm rate of a z-test: 1e-4

using Settings = std::vector<std::pair<std::string, std::string>>;

inline std::unique_ptr<NoiseModel> WithSettings(std::unique_ptr<NoiseModel> law, const Settings& settings) {
  for (const auto& [key, value] : settings) FindParameter(law->Parameters(), key).SetFromText(value);
  return law;
}

// Noise of exact matches at random places of an image: vectors [x1; x2], px.
inline std::vector<Eigen::Vector4d> SampleNoise(const NoiseModel& law, int num_matches,
                                                std::uint32_t trial = 0) {
  RandomStream place_rng({.seed = 1, .trial = trial, .purpose = 70}),
      rng({.seed = 1, .trial = trial, .purpose = 71});
  std::vector<Correspondence> exact(static_cast<size_t>(num_matches));
  for (Correspondence& match : exact) {
    for (Eigen::Vector2d* x_px : {&match.x1_px, &match.x2_px}) {
      for (const int axis : {0, 1}) (*x_px)(axis) = place_rng.Uniform(0.0, 640.0);
    }
  }
  std::vector<Correspondence> noisy = exact;
  law.AddTo(noisy, rng);
  std::vector<Eigen::Vector4d> noise;
  for (size_t i = 0; i < exact.size(); ++i) {
    noise.emplace_back();
    noise.back() << noisy[i].x1_px - exact[i].x1_px, noisy[i].x2_px - exact[i].x2_px;
  }
  return noise;
}

inline std::vector<double> Coordinate(const std::vector<Eigen::Vector4d>& noise, int k) {
  std::vector<double> values;
  for (const Eigen::Vector4d& e : noise) values.push_back(e(k));
  return values;
}

// Mean and standard error of a function of the noise of a match.
template <typename Function>
Moments ComputeMoments(const std::vector<Eigen::Vector4d>& noise, Function function) {
  Moments moments;
  for (const Eigen::Vector4d& e : noise) moments.Add(function(e));
  return moments;
}

// How many standard errors the mean is away from a value.
inline double ZAgainst(const Moments& moments, double value) {
  return (moments.mean() - value) / moments.standard_error();
}

}  // namespace rcme
