// The cameras of a match file, from its header or given separately.
#pragma once

#include <vector>

#include "estimator/geometry/lens.h"
#include "experiments/data/camera_plausibility.h"
#include "experiments/data/match_file.h"
#include "experiments/data/match_header.h"

namespace rcme {

// Reads camera 1 or 2 (`number`). If none is given, the header must have all of the camera.
Lens ReadLens(const MatchHeader& header, int number, const GivenCameras& given,
              const std::vector<Correspondence>& matches);

// Returns doubts about the cameras of a file.
std::vector<InputDoubt> FindHeaderDoubts(const MatchHeader& header, const MatchFile& file,
                                         const std::array<LensModel, 2>& models, const GivenCameras& given);

}  // namespace rcme
