// Splits the variance of an event into the part between scenes and the part within them (the sampler's
// randomness).
//
// Each of n independent scenes has R repeats. A scene has its own probability p_i, drawn from an unknown law,
// and the event of a repeat is Bernoulli(p_i). With p the mean of p_i, the variance of the event is
//   p (1 - p) = Var(p_i) + E[p_i (1 - p_i)],   between scenes + within them:
// a nested random-effects model without assumptions on the law of the effects. With q_i the share of a
// scene's repeats in which the event happened, qbar their mean and S^2 their variance (n - 1),
//   within  w = mean of R / (R - 1) q_i (1 - q_i),
//   between b = S^2 - w / R,
//   total   v = b + w = qbar (1 - qbar) + S^2 / n
// are unbiased. b / v is the analysis-of-variance estimator of the intraclass correlation.
#pragma once

#include <cstdint>
#include <vector>

#include "stats/intervals.h"

namespace rcme {

struct VarianceSplit {
  std::int64_t num_scenes = 0;
  double between = 0.0, within = 0.0;  // unbiased; `between` may be below zero; NaN below two scenes
  // within / (between + within), clipped to [0, 1]; the rest is the share between scenes. NaN if nothing
  // varies.
  double within_share = 0.0;
  // By default 95 %. Student's on the logarithm of the share by the delta method, after adding three scenes
  // in which the event happens always, never, and in half of the repeats (as Agresti & Coull add trials to a
  // rate), and widened to contain within_share. Two exceptions: with fewer than 25 scenes of both outcomes
  // the lower end is at most that from the exact bound of the share of such scenes (each has at least w = 1 /
  // R); with fewer than 10 scenes in which the event happened at all, or in which it failed to, the interval
  // is [0, 1]. The coverage is not exact: 0.93 to 1 if influential scenes are not much rarer than one in n;
  // down to 0.85 where a sample contains none of them. Measured in tests/stats/variance_split_test.cc.
  Interval within_share_interval{0.0, 1.0};
  std::int64_t num_mixed = 0;  // scenes in which the event happened in some repeats only
  Interval mixed_interval;     // of their share among all scenes: exact (Clopper-Pearson)
};

// Scenes with the same number of repeats, in constant memory.
class RepeatedEvents {
 public:
  // Throws std::invalid_argument below two repeats.
  explicit RepeatedEvents(int num_repeats);

  // Adds a scene in which the event happened in `num_events` of the repeats. Throws std::invalid_argument
  // outside of 0..num_repeats.
  void AddScene(int num_events);

  VarianceSplit Split(double confidence = 0.95) const;

 private:
  int num_repeats_;
  std::int64_t num_scenes_ = 0;
  std::vector<std::int64_t> num_scenes_with_;  // per number of events, 0..num_repeats
};

}  // namespace rcme
