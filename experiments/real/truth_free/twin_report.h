// What an estimator does on real pairs beside what it does on their simulated twins.
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
  bool is_fitted = false;  // the twin was made to agree in it; else predicted
  std::int64_t n = 0;      // observed values
  double observed = 0.0, predicted = 0.0;
  // Of the observed value, at 1 - 0.05 / (quantities of the scene and twin), so that all hold together with
  // 0.95 where simulation is right. Pairs with a common image are not independent (stats/shared_members.h);
  // means of a semi-real twin are compared pair by pair.
  Interval joint;
  // Of a rate, half of one of the twins' events: so well a rate of 0 or 1 of theirs is known.
  double half_event = 0.0;
  bool IsWithin() const {
    return joint.Contains(is_rate ? std::clamp(predicted, half_event, 1.0 - half_event) : predicted);
  }
};

struct TwinReport {
  std::string scene;
  int num_pairs = 0;
  TwinFit fit;
  Settings semi_real, simulated;  // data blocks; `simulated` empty: impossible, because:
  std::string why_not_simulated;
  std::vector<TwinComparison> comparisons;

  // Of one twin and the quantities that are fitted, or that are predicted: how many are compared, and how
  // many lie within.
  int NumCompared(const std::string& twin, bool fitted) const;
  int NumWithin(const std::string& twin, bool fitted) const;
};

// `folder`: where the templates of the scene will be. `num_twins`: of each pair, of either kind; what a pair
// or a twin gives is a step. Pure in the seed and the pairs' names.
TwinReport MakeTwinReport(const TwinSource& source, const MotionEstimator& estimator,
                          const std::string& folder, double assumed_sigma_px, std::uint64_t seed,
                          int num_twins, KeptSteps* steps = nullptr);

}  // namespace rcme
