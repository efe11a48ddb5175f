#pragma once

#include <algorithm>

namespace rcme {

// Of the uniform distribution on [0, 1].
inline double UniformCdf(double u) { return std::clamp(u, 0.0, 1.0); }

}  // namespace rcme
