// Quantities that are compared between pairs and their twins.
#pragma once

#include <array>
#include <vector>

#include "estimator/motion_estimator.h"
#include "experiments/data/data_source.h"

namespace rcme {

enum TwinQuantity : size_t {
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
  bool is_fitted;  // a twin is fitted to it, so that agreement is no evidence
  const char* words;
  const char* missing;  // what the simulation may lack if the twins differ
};
extern const std::array<QuantityText, kNumQuantities> kQuantityTexts;

// The values of one pair or one twin: none, one or several of each quantity.
using Values = std::array<std::vector<double>, kNumQuantities>;
// The halves use the random streams of the trials after `name`.
Values ComputeValues(const TrialData& trial, const MotionEstimate& estimate, const MotionEstimator& estimator,
                     const StreamName& name);

}  // namespace rcme
