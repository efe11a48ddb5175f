// The cameras of a match file, from its header or given separately.
#pragma once

#include <string>
#include <vector>

#include "estimator/geometry/lens.h"
#include "experiments/data/camera_plausibility.h"
#include "experiments/data/match_file.h"
#include "experiments/data/match_header.h"

namespace rcme {

// Reads camera 1 or 2 (`number`). x_px selects the points in its image. If `given` is null, the header must
// have all of the camera.
Lens ReadLens(const MatchHeader& header, const std::string& number, const Lens* given,
              const std::vector<Correspondence>& matches, Eigen::Vector2d Correspondence::*x_px);

// Returns doubts about the cameras of a file. `is_given`: K was not read from the file.
std::vector<CameraDoubt> FindHeaderDoubts(const MatchHeader& header, const MatchFile& file, bool is_given);

}  // namespace rcme
