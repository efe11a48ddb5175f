#pragma once

#include <string>

namespace rcme {

// Instruction set that the kernels use on this machine: "scalar", "AVX2", "AVX-512", elsewhere Highway's name
// ("NEON"). Stored with results, so that two runs can be compared.
std::string InstructionSetName();

}  // namespace rcme
