#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "estimator/geometry/correspondence.h"
#include "parameters/parameter.h"
#include "stats/random.h"

namespace rcme {

// A law of detection noise: the plug-in contract of simulator/noise. Configured once, then const and shared
// by threads.
//
// Every law has the key sigma_px, and scales itself so that sigma_px is the root mean square of the noise
// over the four coordinates of a match: laws differ in shape, not in power. (The exception is
// `quantised`, whose rounding adds noise that its sigma_px does not include.)
class NoiseModel {
 public:
  virtual ~NoiseModel() = default;
  // The parameters by name, sigma_px among them; valid as long as the model lives.
  virtual std::vector<Parameter> Parameters() = 0;
  virtual double sigma_px() const = 0;
  // Which point of the scene each match is of: `points` holds 0, 1, ..., a point for each match; a law under
  // which some are matched again and others not at all changes it.
  virtual void DrawPoints(std::span<std::uint32_t>, RandomStream&) const {}
  // Adds noise to the exact matches of these points, independent from match to match unless the law says
  // otherwise.
  virtual void AddTo(std::span<Correspondence> matches, RandomStream& rng) const = 0;
  // The same, and what a detector says of it: each match's standard deviation over sigma_px. Empty: it says
  // nothing of single matches.
  virtual std::vector<double> AddAndTell(std::span<Correspondence> matches, RandomStream& rng) const {
    AddTo(matches, rng);
    return {};
  }
};

// The key sigma_px that every law has.
inline Parameter SigmaParameter(double* sigma_px) {
  return Parameter::Real("sigma_px", sigma_px, {1e-9, 1000.0}, "px",
                         "standard deviation of the noise per coordinate (root mean square)");
}

}  // namespace rcme
