// The data to which a surface over conditions is fitted: a quantity of one estimator in every condition of
// one or more runs, the ranges of the factors, and later draws of the population that have not been run.
#pragma once

#include <string>
#include <vector>

#include "experiments/statistics/marginals.h"

namespace rcme {

struct SurfaceOptions {
  std::string estimator;  // label; empty: the first of the first run
  MarginalQuantity quantity = MarginalQuantity::kFailure;
  int num_candidates = 0;  // number of later draws
};

// Returns JSON (docs/output_formats.md). Throws InputError if the factors of the runs differ, if a run does
// not have the estimator, or if candidates are requested for a study without a population or with a latin
// hypercube, whose earlier draws would change.
std::string SurfaceDataAsJson(const std::vector<std::string>& runs, const SurfaceOptions& options);

}  // namespace rcme
