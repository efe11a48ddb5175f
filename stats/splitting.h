// Multilevel splitting: estimates the probability of an event that is too rare to count directly (Kahn &
// Harris 1951; for static systems subset simulation, Au & Beck 2001).
//
// A state x is drawn from its law. A value measures how near it is to the event, which is "value > 1". With
// levels l_1 < ... < l_m = 1,
//   P(value > 1) = P(value > l_1) P(value > l_2 | value > l_1) ... P(value > 1 | value > l_(m-1)),
// none of which is small. N particles are drawn. At each level the share of particles above it is recorded,
// the others are replaced by copies of these, and all are moved by a Markov chain that leaves the law of x
// given value > level invariant.
//
// Levels and step sizes come from a pilot run and are then fixed. The product of the shares of one replicate
// is therefore unbiased, whatever the levels, however badly the chain mixes and however small N is (Del Moral
// 2004, ch. 9): each survivor has the same expected number of copies, and the chain keeps the law. Levels
// found on the particles themselves would cause a bias of O(1/N). Bad mixing only increases the spread;
// replicates are independent, and their spread gives the error (stats/splitting_rate.h).
//
// Splitting cannot reach events to which no level leads. If failures jump to values far above 1 with nothing
// in between (a wrong mode), particles move to the edge of the ordinary ones, and only chance finds the
// event.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <span>
#include <vector>

#include "stats/random.h"

namespace rcme {

// The interface of a system. It is const, so that threads may share it.
template <typename System>
concept SplittingSystem = requires(const System& system, const typename System::State& state,
                                   RandomStream& rng, bool& is_local) {
  // A state from its law.
  { system.Draw(rng) } -> std::same_as<typename System::State>;
  // A reversible move under which the law is invariant. A local move has the length `step` in (0, 1], at 1 to
  // a (nearly) independent state; other moves redraw a part of the state and ignore the step.
  { system.Propose(state, 0.5, rng, is_local) } -> std::same_as<typename System::State>;
  // How near the state is to the event, which is a value > 1. May be infinite, not NaN.
  { system.Value(state) } -> std::same_as<double>;
};

struct SplittingEffort {
  int num_particles = 200;  // at least 2
  int num_moves = 10;       // moves of each particle at each level, at least 1
  double kept_share = 0.2;  // share of the particles above each level of the pilot
};

struct SplittingLevels {
  std::vector<double> levels;  // ascending, below 1; the last level, 1, is implied
  std::vector<double> steps;   // steps of the local moves above each level
};

enum class PilotEnd {
  kReached,
  kStuck,    // no particle lies above the last level: values are bounded below the event, or all equal
  kTooRare,  // the rate is below kLeastSplittingRate
};
inline constexpr double kLeastSplittingRate = 1e-15;

struct SplittingPilot {
  PilotEnd end = PilotEnd::kReached;
  SplittingLevels levels;
  double last_level = 0.0;      // the last level reached
  std::int64_t num_values = 0;  // number of values computed
};

struct SplittingReplicate {
  double estimate = 1.0;
  std::vector<double> shares;      // shares of the particles above each level and 1, given the previous level
  std::vector<double> acceptance;  // share of accepted local moves above each level
  std::int64_t num_drawn = 0, num_drawn_events = 0;  // plain Monte Carlo: the initial particles
  int num_ancestors = 0;  // number of initial particles that those in the event descend from
  std::int64_t num_values = 0;
};

// N particles of a system above a level.
template <SplittingSystem System>
class SplittingPopulation {
 public:
  SplittingPopulation(const System& system, int num_particles, RandomStream* rng)
      : system_(system), rng_(*rng) {
    for (int i = 0; i < num_particles; ++i) {
      typename System::State state = system_.Draw(rng_);
      const double value = EvaluateState(state);
      particles_.push_back({std::move(state), value, i});
    }
  }

  std::int64_t num_values() const { return num_values_; }
  std::int64_t CountAbove(double level) const {
    return std::ranges::count_if(particles_, [&](const Particle& p) { return p.value > level; });
  }
  // The value that `share` of the particles exceed, at least one of them if values differ.
  double ValueExceededBy(double share) const {
    std::vector<double> values;
    for (const Particle& p : particles_) values.push_back(p.value);
    std::ranges::sort(values);
    const auto num_above =
        std::max<std::ptrdiff_t>(1, std::lround(share * static_cast<double>(values.size())));
    auto at = values.end() - 1 - std::min(num_above, std::ssize(values) - 1);
    while (at != values.begin() && *at == values.back()) --at;
    return *at;
  }
  int NumAncestorsAbove(double level) const {
    std::vector<int> ancestors;
    for (const Particle& p : particles_) {
      if (p.value > level) ancestors.push_back(p.ancestor);
    }
    std::ranges::sort(ancestors);
    return static_cast<int>(std::unique(ancestors.begin(), ancestors.end()) - ancestors.begin());
  }

  // Replaces the particles at or below the level by copies of those above it, of which there must be some.
  // Each is copied equally often, except that the remaining copies go to random ones.
  void KeepAbove(double level) {
    const auto end = std::partition(particles_.begin(), particles_.end(),
                                    [&](const Particle& p) { return p.value > level; });
    const auto num_kept = static_cast<size_t>(end - particles_.begin());
    rng_.Shuffle(std::span(particles_).first(num_kept));
    for (size_t i = num_kept; i < particles_.size(); ++i) particles_[i] = particles_[i % num_kept];
  }

  // Moves every particle once; moves that leave the region above the level are rejected. Returns the share of
  // accepted local moves.
  double MoveAbove(double level, double step) {
    int num_local = 0, num_made = 0;
    for (Particle& p : particles_) {
      bool is_local = false;
      typename System::State proposed = system_.Propose(p.state, step, rng_, is_local);
      const double value = EvaluateState(proposed);
      num_local += is_local;
      if (!(value > level)) continue;
      num_made += is_local;
      p.state = std::move(proposed);
      p.value = value;
    }
    return num_local > 0 ? 1.0 * num_made / num_local : 1.0;
  }

 private:
  struct Particle {
    typename System::State state;
    double value;
    int ancestor;  // index of the initial particle it descends from
  };

  double EvaluateState(const typename System::State& state) {
    ++num_values_;
    return system_.Value(state);
  }

  const System& system_;
  RandomStream& rng_;
  std::vector<Particle> particles_;
  std::int64_t num_values_ = 0;
};

// Target acceptance of local moves, by adapting their length; the choice hardly matters between 1/4 and 1/2.
inline constexpr double kWantedAcceptance = 0.35;

// Chooses levels, each with the share `kept_share` of the particles above it, and step sizes.
template <SplittingSystem System>
SplittingPilot FindLevels(const System& system, const SplittingEffort& effort, RandomStream& rng) {
  SplittingPilot pilot;
  SplittingPopulation<System> population(system, effort.num_particles, &rng);
  double step = 0.5, rate = 1.0;
  const auto end_with = [&](PilotEnd end) {
    pilot.end = end;
    pilot.num_values = population.num_values();
    return pilot;
  };
  for (;;) {
    const double level = population.ValueExceededBy(effort.kept_share);
    if (level >= 1.0) return end_with(PilotEnd::kReached);
    const std::int64_t num_above = population.CountAbove(level);
    if (num_above == 0) return end_with(PilotEnd::kStuck);
    rate *= static_cast<double>(num_above) / effort.num_particles;
    pilot.last_level = level;
    if (rate < kLeastSplittingRate) return end_with(PilotEnd::kTooRare);
    population.KeepAbove(level);
    for (int move = 0; move < effort.num_moves; ++move) {
      const double acceptance = population.MoveAbove(level, step);
      step = std::clamp(step * std::exp(acceptance - kWantedAcceptance), 1e-3, 1.0);
    }
    pilot.levels.levels.push_back(level);
    pilot.levels.steps.push_back(step);
  }
}

// One unbiased estimate of P(value > 1).
template <SplittingSystem System>
SplittingReplicate Split(const System& system, const SplittingEffort& effort, const SplittingLevels& levels,
                         RandomStream& rng) {
  SplittingReplicate replicate;
  SplittingPopulation<System> population(system, effort.num_particles, &rng);
  replicate.num_drawn = effort.num_particles;
  replicate.num_drawn_events = population.CountAbove(1.0);
  const auto count = [&](double level) {
    replicate.shares.push_back(static_cast<double>(population.CountAbove(level)) / effort.num_particles);
    replicate.estimate *= replicate.shares.back();
  };
  for (size_t k = 0; k < levels.levels.size() && replicate.estimate > 0.0; ++k) {
    count(levels.levels[k]);
    if (replicate.estimate == 0.0) break;
    population.KeepAbove(levels.levels[k]);
    double acceptance = 0.0;
    for (int move = 0; move < effort.num_moves; ++move) {
      acceptance += population.MoveAbove(levels.levels[k], levels.steps[k]) / effort.num_moves;
    }
    replicate.acceptance.push_back(acceptance);
  }
  if (replicate.estimate > 0.0) count(1.0);
  replicate.num_ancestors = population.NumAncestorsAbove(1.0);
  replicate.num_values = population.num_values();
  return replicate;
}

}  // namespace rcme
