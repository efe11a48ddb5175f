#pragma once

#include <string>

namespace rcme {

// The instruction set that the kernels use on this machine: "scalar", "AVX2", "AVX-512", otherwise Highway's
// name (such as "NEON"). Results store it so that runs can be compared.
std::string InstructionSetName();

}  // namespace rcme
