// The cameras of a match file, by its header or given beside it.
#pragma once

#include <string>
#include <vector>

#include "estimator/geometry/lens.h"
#include "experiments/data/camera_plausibility.h"
#include "experiments/data/match_file.h"
#include "experiments/data/match_header.h"

namespace rcme {

// Camera 1 or 2 (`number`); x_px: where its image has the matches. Nothing given: the file has to say it all.
Lens ReadLens(const MatchHeader& header, const std::string& number, const Lens* given,
              const std::vector<Correspondence>& matches, Eigen::Vector2d Correspondence::*x_px);

// What is suspicious about the cameras of a file whose K may be given.
std::vector<CameraDoubt> FindHeaderDoubts(const MatchHeader& header, const MatchFile& file, bool is_given);

}  // namespace rcme
