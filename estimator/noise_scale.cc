#include "estimator/noise_scale.h"

#include "stats/median_ratio.h"

namespace rcme {

std::vector<double> ComputeNoiseScale(std::vector<double> sigmas) {
  const double median = ComputeMedian(sigmas);
  for (double& sigma : sigmas) sigma /= median;
  return sigmas;
}

}  // namespace rcme
