// What a surface over conditions is fitted to: of one estimator, a quantity in every condition of one or more
// runs, with what is known of the factors, and later draws of the population that nobody has run.
#pragma once

#include <string>
#include <vector>

#include "experiments/statistics/marginals.h"

namespace rcme {

struct SurfaceOptions {
  std::string estimator;  // label; empty: the first of the first run
  MarginalQuantity quantity = MarginalQuantity::kFailure;
  int num_candidates = 0;  // later draws
};

// As JSON (docs/output_formats.md). The runs have the same factors. Throws InputError where they differ, for
// an estimator that a run does not have, and for candidates of a study without a population, or of a latin
// hypercube, whose earlier draws would change.
std::string SurfaceDataAsJson(const std::vector<std::string>& runs, const SurfaceOptions& options);

}  // namespace rcme
