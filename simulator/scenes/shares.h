#pragma once

#include <string>

namespace rcme {

struct NamedShare {
  std::string key;
  double share;
};

// 1 minus the two shares. Throws InputError that names both keys if they sum to more than 1 (up to rounding:
// 0.9 and 0.1 leave 0).
double RestOfShares(const NamedShare& first, const NamedShare& second);

}  // namespace rcme
