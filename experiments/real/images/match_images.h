#pragma once

#include <string>
#include <vector>

#include "experiments/data/match_file.h"
#include "experiments/real/images/features.h"

namespace rcme {

struct MatchImagesOptions {
  std::string image1, image2;  // undistorted images (a.1)
  std::vector<double> K1, K2;  // fx fy cx cy, px; K2 empty: as K1
  DetectorOptions detector;
  MatcherOptions matcher;
  bool has_scores = false;  // the file gets them: each match's ratio of distances
};

// Putative matches of two images (PNG, JPEG, TIFF, BMP, PNM; grey_image.h), outliers kept, each
// with its sigma (features.h); what is suspicious about K is in `doubts`. Throws InputError if an image
// cannot be read, is of another format or too large, or a K is singular or not that of the image.
MatchFile MatchImages(const MatchImagesOptions& options);

}  // namespace rcme
