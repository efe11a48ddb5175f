// A user's own program: one simulated pair, one estimate.
#include <cstdio>

#include "estimator/estimator_registry.h"
#include "experiments/data/make_data.h"

int main() {
  const rcme::DataSources made =
      rcme::MakeDataSources({{"scene", "uniform_volume"}, {"outlier_ratio", "0.1"}});
  const rcme::StreamName trial{1, 0, 0, 0};
  const rcme::TrialData data = made.sources.at(0).second->Make(trial);
  rcme::RandomStream rng = rcme::StreamFor(trial, rcme::StreamPurpose::kSampling);
  const auto estimator = rcme::MakeEstimator("standard");
  const rcme::MotionEstimate estimate = estimator->Estimate(data.problem, rng);
  const double error_rad =
      rcme::RotationAngleBetween(estimate.cam2_from_cam1.R, data.truth.cam2_from_cam1_true->R);
  std::printf("%s, rotation error %.4f rad\n", rcme::StatusName(estimate.status).c_str(), error_rad);
  return estimate.status == rcme::MotionStatus::kOk && error_rad < 0.05 ? 0 : 1;
}
