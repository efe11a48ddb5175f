// The data blocks of the two kinds of twins.
#pragma once

#include <string>

#include "experiments/real/truth_free/twin_fit.h"
#include "parameters/settings.h"

namespace rcme {

// The real layout with noise and wrong matches drawn anew. `folder`: folder of the templates.
Settings SemiRealData(const TwinFit& fit, const std::string& folder, double assumed_sigma_px);

// A simulated scene whose keys are fitted to the measurements, with a given share of its points in clusters.
Settings SimulatedTwinData(const TwinFit& fit, double clustered_share, double assumed_sigma_px);
// The share of points in clusters whose Clark-Evans index is nearest to that of the pairs. Throws InputError
// if no scene of its kind has the measured parallax.
double FitClusteredShare(const TwinFit& fit);

}  // namespace rcme
