#include "simulator/noise_model.h"

namespace rcme {

std::vector<Parameter> Parameters(NoiseModel& noise) {
  return {Parameter::Real("sigma_px", &noise.sigma_px, {1e-9, 1000.0}, "px",
                          "standard deviation of the noise per coordinate; the estimators are told it")};
}

}  // namespace rcme
