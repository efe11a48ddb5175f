// The data blocks of the two kinds of twins.
#pragma once

#include <string>

#include "experiments/real/truth_free/twin_fit.h"
#include "parameters/settings.h"

namespace rcme {

// The real layout, noise and wrong matches drawn anew; `folder`: that of the templates.
Settings SemiRealData(const TwinFit& fit, const std::string& folder, double assumed_sigma_px);

// A simulated scene whose keys are fitted to the same numbers, with that share of its points in clusters.
Settings SimulatedTwinData(const TwinFit& fit, double clustered_share, double assumed_sigma_px);
// The share of points in clusters that resembles the pairs. Throws InputError where no scene of its kind has
// the parallax that was measured.
double FitClusteredShare(const TwinFit& fit);

}  // namespace rcme
