#include <cmath>

#include "simulator/noise/coordinates.h"
#include "simulator/noise/noise_laws.h"
#include "stats/portable_math.h"

namespace rcme {
namespace {

// Gamma(shape, 1), shape >= 1 (Marsaglia & Tsang 2000): d (1 + c Z)^3 with d = shape - 1/3, c = 1 / sqrt(9 d)
// is nearly gamma, and accepted with the ratio of the densities in more than 95 % of the draws. Only
// arithmetic, square roots and PortableLog are used, for reproducibility across machines (stats/random.h).
double DrawGamma(double shape, RandomStream& rng) {
  const double d = shape - 1.0 / 3.0, c = 1.0 / std::sqrt(9.0 * d);
  while (true) {
    const double z = rng.Normal(), root = 1.0 + c * z;
    if (root <= 0.0) continue;
    const double v = root * root * root;
    const double log_u = PortableLog(1.0 - rng.Uniform());  // 1 - U is in (0, 1]
    if (log_u < 0.5 * z * z + d * (1.0 - v + PortableLog(v))) return d * v;
  }
}

// Student's t, independent in every coordinate: the tails of a detector that fails in one direction at a
// time. (The multivariate t would make all four errors large at once, as `contaminated` does.) t with m
// degrees of freedom is Z / sqrt(chi^2_m / m) and has variance m / (m - 2).
class StudentNoise : public NoiseModel {
 public:
  std::vector<Parameter> Parameters() override {
    return {SigmaParameter(&sigma_px_), Parameter::Real("student_dof", &dof_, {2.01, 1e6}, "",
                                                        "degrees of freedom; 2: infinite variance")};
  }

  void AddTo(std::span<Correspondence> matches, RandomStream& rng) const override {
    const double scale_px = sigma_px_ * std::sqrt((dof_ - 2.0) / dof_);
    for (Correspondence& match : matches) {
      for (double* x_px : Coordinates(match)) {
        const double z = rng.Normal(), chi_square = 2.0 * DrawGamma(0.5 * dof_, rng);
        *x_px += scale_px * z / std::sqrt(chi_square / dof_);
      }
    }
  }

 private:
  double dof_ = 5.0;
};

}  // namespace

std::unique_ptr<NoiseModel> MakeStudentNoise() { return std::make_unique<StudentNoise>(); }

}  // namespace rcme
