// Compares an estimator's results on real pairs with those on their simulated twins.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "estimator/motion_estimator.h"
#include "experiments/real/truth_free/twin_fit.h"
#include "stats/intervals.h"

namespace rcme {

// One quantity of a scene, observed on the pairs and predicted by a twin.
struct TwinComparison {
  std::string quantity;
  std::string twin;  // semi_real, simulated
  bool is_rate = false;
  bool is_fitted = false;  // the twin was fitted to it; else predicted
  std::int64_t n = 0;      // observed values
  double observed = 0.0, predicted = 0.0;
  // Interval of the observed value. Its confidence is 1 - 0.05 / (number of quantities of the scene and
  // twin), so that if the simulation is right all intervals hold jointly with 0.95. It accounts for pairs
  // with a common image (stats/shared_members.h). Means of a semi-real twin are compared pair by pair.
  Interval joint;
  // For rates 0.5 / (number of the twins' events), the resolution of a twin rate of 0 or 1.
  double half_event = 0.0;
  bool IsWithin() const {
    return joint.Contains(is_rate ? std::clamp(predicted, half_event, 1.0 - half_event) : predicted);
  }
};

struct TwinReport {
  std::string scene;
  int num_pairs = 0;
  TwinFit fit;
  Settings semi_real, simulated;  // data blocks; `simulated` is empty if no scene can be simulated
  std::string why_not_simulated;
  std::vector<TwinComparison> comparisons;

  // Number of quantities of one twin that are compared, and of those within their interval; fitted or
  // predicted ones.
  int NumCompared(const std::string& twin, bool fitted) const;
  int NumWithin(const std::string& twin, bool fitted) const;
};

// `folder`: where the templates of the scene will be. `num_twins`: twins per pair of each kind. The values of
// each pair and each twin are a step. Random streams depend on the seed and the names of scene and pairs;
// those of simulated twins on the pair's number in place of its name.
TwinReport MakeTwinReport(const TwinSource& source, const MotionEstimator& estimator,
                          const std::string& folder, double assumed_sigma_px, std::uint64_t seed,
                          int num_twins, KeptSteps* steps = nullptr);

}  // namespace rcme
