#include "experiments/claims/families.h"

namespace rcme {

std::vector<Claim> MleClaims() { return {}; }

}  // namespace rcme
