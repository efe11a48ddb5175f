#include "stats/eigen_solvers.h"

namespace Eigen {
RCME_SOLVERS_OF_OTHER_SIZES()
}  // namespace Eigen
