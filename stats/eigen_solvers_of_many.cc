#include "stats/eigen_solvers.h"

namespace Eigen {
RCME_SOLVERS_OF_MANY()
}  // namespace Eigen
