// The data blocks of the two kinds of twins.
#pragma once

#include <string>

#include "experiments/truth_free/twin_fit.h"
#include "parameters/settings.h"

namespace rcme {

// Data blocks of studies: the real layout, noise and wrong matches drawn anew (`folder`: that of the
// templates); and a simulated scene, whose keys are fitted to the same numbers. The second throws InputError
// where no scene of its kind has the parallax that was measured.
Settings SemiRealData(const TwinFit& fit, const std::string& folder, double assumed_sigma_px);
Settings SimulatedTwinData(const TwinFit& fit, double assumed_sigma_px);

}  // namespace rcme
