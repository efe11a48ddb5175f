// Match files for tests, written by hand-made pinhole projection.
#pragma once

#include <fmt/format.h>

#include <string>

#include "stats/random.h"

namespace rcme {

// 640 x 480, f = 600, the principal point in the middle.
inline std::string MatchHeader() {
  return "# size1: 640 480\n# size2: 640 480\n# K1_fx_fy_cx_cy: 600 600 319.5 239.5\n"
         "# K2_fx_fy_cx_cy: 600 600 319.5 239.5\n";
}

// The true motion of MatchRows: R = I, t = (0.8, 0.6, 0).
inline std::string TruePoseHeader() { return "# R_rowmajor: 1 0 0 0 1 0 0 0 1\n# t_unit: 0.8 0.6 0\n"; }

// Rows "x1,y1,x2,y2" of `n` points at depths of 4 to 12 baselines, without noise.
inline std::string MatchRows(int n, std::uint64_t seed = 1) {
  RandomStream rng({.seed = seed, .purpose = 77});
  std::string rows;
  for (int i = 0; i < n; ++i) {
    const double depth = rng.Uniform(4.0, 12.0);
    const double x1 = rng.Uniform(100.0, 500.0), y1 = rng.Uniform(100.0, 350.0);
    rows += fmt::format("{},{},{},{}\n", x1, y1, x1 + 600.0 * 0.8 / depth, y1 + 600.0 * 0.6 / depth);
  }
  return rows;
}

}  // namespace rcme
