#include "stats/variance_split.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "stats/constants.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

constexpr std::int64_t kFewMixedScenes = 25, kFewScenesOfAKind = 10;

// A number of scenes with the same share q of events.
struct EqualScenes {
  double q = 0.0, count = 0.0;
};

// w, v and qbar of variance_split.h.
struct Components {
  double within = 0.0, total = 0.0, mean = 0.0, num_scenes = 0.0;
};

double ComputeWithin(double q, int num_repeats) {
  const double repeats = num_repeats;
  return repeats / (repeats - 1.0) * q * (1.0 - q);
}

Components ComputeComponents(const std::vector<EqualScenes>& scenes, int num_repeats) {
  Components c;
  for (const EqualScenes& each : scenes) {
    c.num_scenes += each.count;
    c.mean += each.count * each.q;
    c.within += each.count * ComputeWithin(each.q, num_repeats);
  }
  c.mean /= c.num_scenes;
  c.within /= c.num_scenes;
  double squares = 0.0;
  for (const EqualScenes& each : scenes) squares += each.count * (each.q - c.mean) * (each.q - c.mean);
  c.total = c.mean * (1.0 - c.mean) + squares / (c.num_scenes - 1.0) / c.num_scenes;
  return c;
}

// Standard error of log(w / v). The influence of a scene is (w_i - w) / w - (1 - 2 qbar) (q_i - qbar) / v.
double StandardErrorOfLogShare(const std::vector<EqualScenes>& scenes, int num_repeats, const Components& c) {
  double squares = 0.0;
  for (const EqualScenes& each : scenes) {
    const double influence = (ComputeWithin(each.q, num_repeats) - c.within) / c.within -
                             (1.0 - 2.0 * c.mean) * (each.q - c.mean) / c.total;
    squares += each.count * influence * influence;
  }
  return std::sqrt(squares / (c.num_scenes - 1.0) / c.num_scenes);
}

}  // namespace

RepeatedEvents::RepeatedEvents(int num_repeats)
    : num_repeats_(num_repeats), num_scenes_with_(static_cast<size_t>(std::max(num_repeats, 0)) + 1, 0) {
  if (num_repeats < 2) throw std::invalid_argument("variance split: two repeats per scene are needed");
}

void RepeatedEvents::AddScene(int num_events) {
  if (num_events < 0 || num_events > num_repeats_)
    throw std::invalid_argument("variance split: more events in a scene than repeats");
  ++num_scenes_;
  ++num_scenes_with_[static_cast<size_t>(num_events)];
}

VarianceSplit RepeatedEvents::Split(double confidence) const {
  VarianceSplit split;
  split.num_scenes = num_scenes_;
  split.num_mixed = num_scenes_ - num_scenes_with_.front() - num_scenes_with_.back();
  split.mixed_interval = ExactBinomialInterval(split.num_mixed, num_scenes_, confidence);
  split.between = split.within = split.within_share = kNaN;
  if (num_scenes_ < 2) return split;
  std::vector<EqualScenes> scenes;
  for (int k = 0; k <= num_repeats_; ++k) {
    const double count = static_cast<double>(num_scenes_with_[static_cast<size_t>(k)]);
    if (count > 0.0) scenes.push_back({static_cast<double>(k) / num_repeats_, count});
  }
  const Components c = ComputeComponents(scenes, num_repeats_);
  split.within = c.within;
  split.between = c.total - c.within;
  if (!(c.total > 0.0)) return split;
  split.within_share = std::clamp(c.within / c.total, 0.0, 1.0);
  if (std::min(num_scenes_ - num_scenes_with_.front(), num_scenes_ - num_scenes_with_.back()) <
      kFewScenesOfAKind) {
    return split;
  }
  scenes.insert(scenes.end(), {{0.0, 1.0}, {0.5, 1.0}, {1.0, 1.0}});
  const Components more = ComputeComponents(scenes, num_repeats_);
  const double reach = StudentQuantile(static_cast<int>(num_scenes_) + 2, 0.5 * (1.0 + confidence)) *
                       StandardErrorOfLogShare(scenes, num_repeats_, more);
  const double center = more.within / more.total;
  double lower = center * std::exp(-reach);
  if (split.num_mixed < kFewMixedScenes)
    lower = std::min(lower, split.mixed_interval.lower / num_repeats_ / more.total);
  split.within_share_interval = {std::min(lower, split.within_share),
                                 std::min(1.0, std::max(center * std::exp(reach), split.within_share))};
  return split;
}

}  // namespace rcme
