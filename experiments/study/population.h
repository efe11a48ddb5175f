// Conditions as a random sample from a population, instead of chosen levels.
//
// A population defines the possible values of data keys. Draw number i is a pure function of the study's
// seed and i: a point of the unit cube with one axis per key (stats/point_set.h), mapped through the ranges.
// A key that only some scenes or laws have is drawn if one of these was drawn, and is absent otherwise.
// Draws that violate a restriction in `given` keep their number and are listed in StudyPlan::refused; the
// population is that of the other draws. If the simulator cannot make a trial of a draw, the trial has the
// outcome MotionStatus::kNotSimulated.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "parameters/settings.h"
#include "stats/point_set.h"

namespace rcme {

struct Study;

inline constexpr int kMaxDraws = 100'000;
inline constexpr const char* kDrawFactor = "draw";  // a factor; its level is the draw's number
inline constexpr const char* kNotDrawn = "-";       // level of a key that a draw does not have

// The possible values of a key: a number, uniform or log-uniform between two ends (for whole numbers both
// ends are included), or one of several words or numbers with equal probability.
struct DrawnRange {
  enum class Kind { kUniform, kLogUniform, kAnyOf };
  Kind kind = Kind::kAnyOf;
  double from = 0.0, to = 0.0;
  std::vector<std::string> words;  // a single word: the key is fixed
};

struct DrawnKey {
  std::string key;
  // The choices with which the key is drawn, outermost first: {{"scene", "plane"}}. Empty: whenever the data
  // have such a key.
  Settings with;
  DrawnRange range;
  std::string place = {};  // "study.yaml:12": of the key in the file that has it
};

// A comparison of two sides, each a key or a number: "sigma_px < 2", "min_depth_m < max_depth_m". It does
// not restrict draws that lack one of the keys or have a word as its value.
struct Restriction {
  std::string left, comparison, right;
  std::string Text() const { return left + " " + comparison + " " + right; }
};

struct Population {
  PointSet design = PointSet::kSobol;
  int number = 256;  // number of draws
  // Ascending numbers of chosen draws, which are no sample. Empty: 0, ..., number - 1.
  std::vector<int> draws;
  // Each key is followed by the keys that are drawn with its words. This is the order of the axes.
  std::vector<DrawnKey> keys;
  std::vector<Restriction> given;
};

// Returns the keys in the order of their axes, each once.
std::vector<std::string> ListDrawnKeys(const Population& population);

// Returns the number of the draw that a condition comes from; nothing if there is no factor kDrawFactor.
std::optional<int> FindDraw(const std::vector<std::string>& factors, const std::vector<std::string>& levels);

struct PopulationDraw {
  int number = 0;
  std::vector<std::string> levels;  // one per key of ListDrawnKeys; kNotDrawn
  std::string outside_of;           // first restriction that it violates; empty: none
};

// Returns all draws in order. Throws InputError if the study's data contradict a drawn key, or if the design
// does not have the number of a chosen draw.
std::vector<PopulationDraw> DrawPopulation(const Study& study);

// A draw that is not among the conditions, because it violates a restriction.
struct RefusedDraw {
  int number = 0;
  std::string outside_of;  // the restriction
};

// DescribePopulationIdentity returns the lines for a run's identity. DescribePopulation explains such an
// identity: the number of draws, how many are conditions, and how many violate each restriction. Empty if
// there is no population.
std::string DescribePopulationIdentity(const Population& population, const std::vector<RefusedDraw>& refused);
std::string DescribePopulation(const std::string& identity);
// Returns whether the identity is that of a sample from a population, rather than of a grid or of chosen
// draws.
bool IsSampleOfPopulation(const std::string& identity);
// Returns whether the identity is that of chosen draws of a population (Population::draws).
bool HasChosenDraws(const std::string& identity);

}  // namespace rcme
