#pragma once

#include <string>
#include <vector>

#include "experiments/data/match_file.h"
#include "experiments/real/images/features.h"

namespace rcme {

struct MatchImagesOptions {
  std::string image1, image2;  // undistorted images (a.1)
  std::vector<double> K1, K2;  // fx fy cx cy, px; empty K2: same as K1
  DetectorOptions detector;
  MatcherOptions matcher;
  bool has_scores = false;  // the match file gets the ratio of distances of each match
};

// Matches two images (PNG, JPEG, TIFF, BMP, PNM; grey_image.h). The putative matches still contain outliers;
// each has its sigma (features.h). `doubts` has what is suspicious about K. Throws InputError if an image
// cannot be read, has another format or is too large, or if K is singular or certainly not that of the
// image.
MatchFile MatchImages(const MatchImagesOptions& options);

}  // namespace rcme
