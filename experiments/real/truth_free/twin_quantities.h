// What is compared between pairs and their twins.
#pragma once

#include <array>
#include <vector>

#include "estimator/motion_estimator.h"
#include "experiments/data/data_source.h"

namespace rcme {

enum Quantity : size_t {
  kRefusal,
  kFailure,
  kStatedFailure,
  kSigma,
  kAcceptedShare,
  kInlierTest,
  kTailShare,
  kRotationSd,
  kDirectionSd,
  kSpatialHalves,
  kRandomHalves,
  kNearCorrelation,
  kFarCorrelation,
  kNumQuantities
};

struct QuantityText {
  const char* name;
  bool is_rate;
  bool is_fitted;  // a twin is made to agree in it: no evidence where it does
  const char* words;
  const char* missing;  // what simulation may lack where it is not met
};
extern const std::array<QuantityText, kNumQuantities> kQuantityTexts;

// The values of one pair, or of one twin: none, one or several of each quantity.
using Values = std::array<std::vector<double>, kNumQuantities>;
// Halves are estimated with samples of the streams after `name`.
Values ComputeValues(const TrialData& trial, const MotionEstimate& estimate, const MotionEstimator& estimator,
                     const StreamName& name);

}  // namespace rcme
