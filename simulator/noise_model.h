#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "estimator/geometry/correspondence.h"
#include "parameters/parameter.h"
#include "stats/random.h"

namespace rcme {

// A law of detection noise: the interface of the files in simulator/noise. Configured once, then const and
// shared by threads.
//
// Every law has the key sigma_px, the root mean square of the noise over the four coordinates of a match:
// laws differ in shape, not in power. (The exception is `quantised`, whose rounding adds noise beyond
// sigma_px.)
class NoiseModel {
 public:
  virtual ~NoiseModel() = default;
  // The parameters by name, sigma_px among them; valid as long as the model lives.
  virtual std::vector<Parameter> Parameters() = 0;
  double sigma_px() const { return sigma_px_; }
  // Assigns a scene point to each match. `points` holds 0, 1, ..., one point per match; a law that detects
  // some points several times changes it, so that other points are not matched.
  virtual void DrawPoints(std::span<std::uint32_t>, RandomStream&) const {}
  // Adds noise to exact matches, independent between matches unless the law says otherwise.
  virtual void AddTo(std::span<Correspondence> matches, RandomStream& rng) const = 0;
  // The same; also returns each match's standard deviation over sigma_px as a detector would state it. Empty:
  // the detector states nothing.
  virtual std::vector<double> AddAndTell(std::span<Correspondence> matches, RandomStream& rng) const {
    AddTo(matches, rng);
    return {};
  }

 protected:
  double sigma_px_ = 0.5;
};

// The key sigma_px that every law has.
inline Parameter SigmaParameter(double* sigma_px) {
  return Parameter::Real("sigma_px", sigma_px, {1e-9, 1000.0}, "px", "rms noise per coordinate");
}

}  // namespace rcme
