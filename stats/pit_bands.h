// Are n probability integral transforms uniform? Simultaneous bands of their empirical distribution function
// (Saeilynoja, Buerkner & Vehtari 2022): at each of K points z_i = i / K the number of values <= z_i is
// Binomial(n, z_i); the pointwise intervals are all taken at one level gamma, chosen so that the whole curve
// stays inside with probability 1 - alpha. The graph then shows where and how a law is missed: a slope is a
// bias, an S a wrong spread.
#pragma once

#include <vector>

namespace rcme {

struct PitBands {
  int n = 0;
  double pointwise_level = 0.0;        // gamma: each point is outside with probability at most gamma
  double simultaneous_coverage = 0.0;  // exact; the least attainable one that is >= the confidence asked for
  std::vector<double> z;               // i / K, i = 1..K
  std::vector<int> lower, upper;       // numbers of values <= z_i, ends included; both n at z = 1
};

// Exact, in time of about n K: 0.03 s at n = 2000, K = 100, and 0.3 s at n = 100,000. Throws
// std::invalid_argument unless 1 <= n <= 100,000, 2 <= K <= 1000 and 0 < confidence < 1.
PitBands SimultaneousPitBands(int n, int num_points, double confidence = 0.95);

// The probability that the counts of n independent uniforms stay within [lower_i, upper_i] at z_i = i / K,
// i = 1..K, K = lower.size().
double SimultaneousCoverage(int n, const std::vector<int>& lower, const std::vector<int>& upper);

struct PitCheck {
  std::vector<int> counts;   // values <= z_i
  std::vector<int> outside;  // the i whose count is outside its band
  int num_invalid = 0;       // NaN or outside [0, 1]; not counted
  bool IsUniform() const { return outside.empty() && num_invalid == 0; }
};

// Throws std::invalid_argument if there are not bands.n values.
PitCheck CheckPit(const std::vector<double>& values, const PitBands& bands);

}  // namespace rcme
