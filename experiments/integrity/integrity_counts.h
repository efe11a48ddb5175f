// Errors of answers against their protection levels (estimator/protection_level.h) as counts, which add up
// over trials: the regions of the Stanford diagram, and the diagram itself on a grid.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "experiments/trial/trial.h"

namespace rcme {

// What the levels are computed and judged by.
struct IntegrityTerms {
  double risk = 1e-3;                                          // of an error beyond its level, per answer
  double rotation_limit_deg = 1.0, direction_limit_deg = 5.0;  // alert limits

  double LimitDeg(size_t quantity) const { return quantity == 0 ? rotation_limit_deg : direction_limit_deg; }
};

inline constexpr size_t kNumIntegrityQuantities = 2;
// What a robot has to fear is either: a trial counts as misleading or hazardous if its rotation or its
// direction is, and as available if both are. It is counted itself: no bound of the two rates is needed.
inline constexpr size_t kEither = kNumIntegrityQuantities;
const char* IntegrityQuantityName(size_t quantity);  // "rotation", "direction", "either"

// Where an answer lies, by its error, its level and the alert limit.
enum class StanfordRegion {
  kAvailable,              // error <= level <= limit
  kMisleading,             // level < error <= limit
  kHazardous,              // level <= limit < error
  kUnavailable,            // limit < level, error <= level
  kUnavailableMisleading,  // limit < level < error
};
inline constexpr size_t kNumStanfordRegions = 5;
const char* Name(StanfordRegion region);  // "available", "misleading", ...
StanfordRegion FindStanfordRegion(double error, double level, double limit);

using RegionCounts = std::array<std::int64_t, kNumStanfordRegions>;

// Of trials with a known outcome. A trial without a motion is one without a protection level.
struct IntegrityTally {
  std::int64_t num_without_motion = 0;
  std::array<RegionCounts, kNumIntegrityQuantities> regions{};
  struct Either {
    std::int64_t num_answers = 0;  // with a known truth of both
    std::int64_t num_available = 0, num_misleading = 0, num_hazardous = 0;
  } either;

  void Add(const IntegrityTally& other);
  // `quantity`: also kEither.
  std::int64_t NumAnswers(size_t quantity) const;
  std::int64_t NumTrials(size_t quantity) const { return num_without_motion + NumAnswers(quantity); }
  std::int64_t NumAvailable(size_t quantity) const;   // level <= limit
  std::int64_t NumMisleading(size_t quantity) const;  // level < error
  std::int64_t NumHazardous(size_t quantity) const;
};

// The grid of errors and levels: bin k is of (edge k, edge k + 1] with edge k = 180 deg 10^((k - 100) / 16);
// the first also has what is less.
inline constexpr int kNumIntegrityBins = 100, kIntegrityBinsPerDecade = 16;
double IntegrityEdgeDeg(int k);
int FindIntegrityBin(double angle_deg);

// How much of it hangs on a truth that has an error of its own (Truth::sd). Errors are taken against the
// truth as it is given; were each truth off by kTruthReachSds of its standard deviations, towards the answer
// or away from it, so many would be misleading and hazardous. An exact truth moves nothing.
inline constexpr double kTruthReachSds = 2.0;
struct TruthSensitivity {
  struct Range {
    std::int64_t least = 0, most = 0;
  };
  std::array<std::int64_t, kNumIntegrityQuantities> num_inexact{};  // answers with such a truth
  std::array<Range, kNumIntegrityQuantities> misleading{}, hazardous{};

  void Add(const TruthSensitivity& other);
};

struct IntegrityCounts {
  IntegrityTally tally;
  TruthSensitivity truth_sensitivity;
  std::int64_t num_refusals = 0, num_invalid = 0;  // their sum is that of the tally without a motion
  std::int64_t num_not_simulated = 0;
  std::array<std::int64_t, kNumIntegrityQuantities> num_unscored{};  // whose truth is not known or in doubt
  // error bin * kNumIntegrityBins + level bin -> answers
  std::array<std::map<int, std::int64_t>, kNumIntegrityQuantities> cells;

  void Add(const IntegrityCounts& other);
};

// One trial of a single estimator.
IntegrityCounts CountTrial(const TrialResult& result, const IntegrityTerms& terms);

// A text of JSON on one line, and back. `most`: trials that it is of. Throws std::invalid_argument for
// numbers that no trials give.
std::string IntegrityCountsAsText(const IntegrityCounts& counts,
                                  const std::map<std::int64_t, IntegrityTally>& scenes);
IntegrityCounts ReadIntegrityCounts(const std::string& text, std::int64_t most,
                                    std::map<std::int64_t, IntegrityTally>* scenes);

}  // namespace rcme
