#pragma once

#include <string>

namespace rcme {

struct NamedShare {
  std::string key;
  double share;
};

// What two shares leave of 1. Throws InputError that names both keys if they sum to more (give or take
// rounding: 0.9 and 0.1 leave nothing).
double RestOfShares(const NamedShare& first, const NamedShare& second);

}  // namespace rcme
