#pragma once

#include <string>
#include <vector>

#include "experiments/data/match_file.h"

namespace rcme {

struct MatchImagesOptions {
  std::string image1, image2;  // undistorted images (a.1)
  std::vector<double> K1, K2;  // fx fy cx cy, px; K2 empty: as K1
  double max_ratio = 0.8;      // Lowe's ratio test
};

// Putative SIFT matches of two images (PNG, JPEG, TIFF, BMP, PNM; at most 4096 x 4096 px), outliers kept.
// Throws InputError if an image cannot be read, is of another format or too large, or a K is singular.
MatchFile MatchImages(const MatchImagesOptions& options);

}  // namespace rcme
