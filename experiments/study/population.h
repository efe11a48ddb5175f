// Conditions as a random sample of a population, instead of levels that somebody chose.
//
// A population says of each key of the data what it may be. Draw number i is a pure function of the study's
// seed and i: a point of the unit cube with an axis for each key (stats/point_set.h), through the ranges. A
// key that a scene or a law brings is drawn where that was drawn, and is absent elsewhere. Draws outside of
// `given` keep their place in the sequence and are named (StudyPlan::refused): the population is that of the
// draws that remain. What the simulator cannot make of these is an outcome of their trials
// (MotionStatus::kNotSimulated).
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "parameters/settings.h"
#include "stats/point_set.h"

namespace rcme {

struct Study;

inline constexpr int kMaxDraws = 100'000;
inline constexpr const char* kDrawFactor = "draw";  // the factor whose level is the number of the draw
inline constexpr const char* kNotDrawn = "-";       // the level of a key that a draw does not have

// What a key may be: a number, uniform between two or uniform in its logarithm, both ends included where it
// is whole; or one of several words or numbers, each as likely.
struct DrawnRange {
  enum class Kind { kUniform, kLogUniform, kAnyOf };
  Kind kind = Kind::kAnyOf;
  double from = 0.0, to = 0.0;
  std::vector<std::string> words;  // one: the key is fixed
};

struct DrawnKey {
  std::string key;
  // What it is drawn with, outermost first: {{"scene", "plane"}}; empty: wherever there is such a key.
  Settings with;
  DrawnRange range;
};

// "sigma_px < 2", "min_depth_m < max_depth_m": of two sides that are keys or numbers. A draw without one of
// the keys, or with a word in its place, is not restricted.
struct Restriction {
  std::string left, comparison, right;
  std::string Text() const { return left + " " + comparison + " " + right; }
};

struct Population {
  PointSet design = PointSet::kSobol;
  int number = 256;        // of draws
  std::vector<int> draws;  // their numbers, ascending: chosen ones, no sample; none: 0, ..., number - 1
  // A key, then what is drawn with its words, then the next: the order of their axes.
  std::vector<DrawnKey> keys;
  std::vector<Restriction> given;
};

// The keys, each once, in the order of their axes.
std::vector<std::string> ListDrawnKeys(const Population& population);

// Of the draws; a chosen one of sobol or random may be beyond Population::number.
int CountDraws(const Population& population);

// The number of the draw that a condition is of, by the names of its factors; nothing without kDrawFactor.
std::optional<int> FindDraw(const std::vector<std::string>& factors, const std::vector<std::string>& levels);

struct PopulationDraw {
  int number = 0;
  std::vector<std::string> levels;  // one per key of ListDrawnKeys; kNotDrawn
  std::string outside_of;           // the restriction it does not meet; empty: none
};

// All of them, in order. Throws InputError if the study's data contradict what is drawn, or for a number that
// the design does not have.
std::vector<PopulationDraw> DrawPopulation(const Study& study);

// A draw that is no condition.
struct RefusedDraw {
  int number = 0;
  std::string outside_of;  // the restriction it does not meet
};

// Lines of a run's identity for them, and what such an identity says, in words: how many draws there were,
// how many are not among the conditions, and the reasons with an example of each, the most frequent first.
// Empty: no population.
std::string DescribePopulationIdentity(const Population& population, const std::vector<RefusedDraw>& refused);
std::string DescribePopulation(const std::string& identity);
// Whether such an identity is of draws that are a sample of a population: of neither a grid nor chosen draws.
bool IsSampleOfPopulation(const std::string& identity);

}  // namespace rcme
