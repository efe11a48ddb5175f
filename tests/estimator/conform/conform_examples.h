// A rule with every part, by hand.
#pragma once

#include "estimator/conform/conform_rule.h"
#include "stats/constants.h"

namespace rcme {

inline constexpr size_t kDirectionSdFeature = static_cast<size_t>(VisibleFeature::kDirectionSd),
                        kAgreeingFeature = static_cast<size_t>(VisibleFeature::kAgreeing);

// Three strata of the direction's log sd (below -7, below -6, above), with factors 1.5, 4 and all motions;
// the log odds are -3 + .5 (log sd + 6), and at most 0 is accepted.
inline ConformRule ExampleRule() {
  ConformRule rule;
  rule.estimator = "standard";
  rule.options = {{"num_iterations", "50"}};
  rule.origin = {"example", {"0123456789abcdef", "23456789abcdef01"}, 21, 2, 21, 1, false};
  rule.difficulty = {0.25, {{kDirectionSdFeature, -6.0, 2.0, 2.0, 0.0}}};  // log sd + 6.25
  rule.edges = {-0.75, 0.25};
  rule.factors = {1.5, 4.0, kInfinity};
  rule.failure = {0.0, {{kDirectionSdFeature, -6.0, 2.0, 1.0, 0.0}}};
  rule.log_odds_intercept = -3.0;
  rule.log_odds_slope = 1.0;
  rule.greatest_log_odds = 0.0;
  rule.familiar_features = {kAgreeingFeature, kDirectionSdFeature};
  for (int i = -10; i <= 10; ++i) {
    rule.familiar.push_back(4.0 + 0.1 * i);
    rule.familiar.push_back(-6.5 + 0.2 * i);
  }
  return rule;
}

inline VisibleFeatures FeaturesWith(double agreeing, double direction_sd) {
  VisibleFeatures features;
  features.fill(kNaN);
  features[kAgreeingFeature] = agreeing;
  features[kDirectionSdFeature] = direction_sd;
  return features;
}

}  // namespace rcme
