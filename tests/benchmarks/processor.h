#pragma once

#include <string>

namespace rcme {

// Maker, family and model of the processor, as "AuthenticAMD 25 17"; "unknown" where /proc/cpuinfo does not
// say. Ratios of one processor do not hold for another, even of the same instruction set: what bounds a
// kernel (divisions, ports, memory) differs.
std::string FindProcessor();

}  // namespace rcme
