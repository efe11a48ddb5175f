// The machine's peak of fused multiply-adds, measured, in the vectors that the kernels use.
#pragma once

#include <string>

namespace rcme {

inline constexpr int kFmaChains = 12;  // independent ones; latency times units is 8 to 10 on current cores
inline constexpr int kFmaSteps = 20'000;

// kFmaChains * kFmaSteps vector FMAs. Returns a value that depends on all of them.
double RunFusedMultiplyAdds();

// Of the kernels here and now.
int LanesPerVector();
std::string InstructionSet();

}  // namespace rcme
