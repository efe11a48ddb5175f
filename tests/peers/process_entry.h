#pragma once

#include <string>

#include "peers/peer_registry.h"

namespace rcme {

// The name of the estimator `process`, which is added once.
inline const std::string& ProcessEntryName() {
  static const std::string name = [] {
    AddOutsideEstimators();
    return std::string("process");
  }();
  return name;
}

}  // namespace rcme
