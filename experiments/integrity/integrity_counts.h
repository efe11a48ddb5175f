// Counts of answers by error and protection level (estimator/protection_level.h): the regions of the Stanford
// diagram, and the diagram itself on a grid. Counts of different trials can be added.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>

#include "experiments/trial/trial.h"

namespace rcme {

// The integrity risk and the alert limits.
struct IntegrityTerms {
  double risk = 1e-3;                                          // P(error > protection level) per answer
  double rotation_limit_deg = 1.0, direction_limit_deg = 5.0;  // alert limits

  double LimitDeg(size_t quantity) const { return quantity == 0 ? rotation_limit_deg : direction_limit_deg; }
};

inline constexpr size_t kNumIntegrityQuantities = 2;
// Rotation and direction together: misleading or hazardous if one of the two is, available if both are. These
// trials are counted directly, so that the rate need not be bounded by the rates of the two.
inline constexpr size_t kEither = kNumIntegrityQuantities;
const char* IntegrityQuantityName(size_t quantity);  // "rotation", "direction", "either"

// The regions of the Stanford diagram, by error, protection level and alert limit.
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

// Counts of the trials with a known outcome. A trial without a valid motion has no protection level.
struct IntegrityTally {
  std::int64_t num_without_motion = 0;
  std::array<RegionCounts, kNumIntegrityQuantities> regions{};
  struct Either {
    std::int64_t num_answers = 0;  // rotation and direction have a known error
    std::int64_t num_available = 0, num_misleading = 0, num_hazardous = 0;
  } either;

  void Add(const IntegrityTally& other);
  // `quantity` may be kEither, here and below.
  std::int64_t NumAnswers(size_t quantity) const;
  std::int64_t NumTrials(size_t quantity) const { return num_without_motion + NumAnswers(quantity); }
  std::int64_t NumAvailable(size_t quantity) const;   // level <= limit
  std::int64_t NumMisleading(size_t quantity) const;  // level < error
  std::int64_t NumHazardous(size_t quantity) const;
};

// The grid of errors and levels. Bin k is (edge k, edge k + 1] with edge k = 180 deg 10^((k - 100) / 16). The
// first bin also has all smaller angles, the last one all greater ones.
inline constexpr int kNumIntegrityBins = 100, kIntegrityBinsPerDecade = 16;
double IntegrityEdgeDeg(int k);
int FindIntegrityBin(double angle_deg);

// How the counts depend on the error of an inexact truth (Truth::sd). The tally takes the truth as exact.
// Here each truth is moved by kTruthErrorSds (trial/truth_error.h) of its standard deviations towards the
// answer (`least`) or away from it (`most`). An exact truth is not moved.
struct TruthSensitivity {
  struct Range {
    std::int64_t least = 0, most = 0;
  };
  std::array<std::int64_t, kNumIntegrityQuantities> num_inexact{};  // answers with an inexact truth
  std::array<Range, kNumIntegrityQuantities> misleading{}, hazardous{};

  void Add(const TruthSensitivity& other);
};

struct IntegrityCounts {
  IntegrityTally tally;
  TruthSensitivity truth_sensitivity;
  std::int64_t num_refusals = 0, num_invalid = 0;  // their sum is tally.num_without_motion
  std::int64_t num_not_simulated = 0;
  std::array<std::int64_t, kNumIntegrityQuantities> num_unscored{};  // truth unknown or in doubt
  // error bin * kNumIntegrityBins + level bin -> number of answers
  std::array<std::map<int, std::int64_t>, kNumIntegrityQuantities> cells;

  void Add(const IntegrityCounts& other);
};

// Counts one trial of a study with one estimator.
IntegrityCounts CountTrial(const TrialResult& result, const IntegrityTerms& terms);

// Write the counts as one line of JSON and read them back. `scenes`: tallies by scene number. `most`: the
// number of trials counted. Reading throws std::exception for text that is not such JSON, and for impossible
// counts.
std::string IntegrityCountsAsText(const IntegrityCounts& counts,
                                  const std::map<std::int64_t, IntegrityTally>& scenes);
IntegrityCounts ReadIntegrityCounts(const std::string& text, std::int64_t most,
                                    std::map<std::int64_t, IntegrityTally>* scenes);

}  // namespace rcme
