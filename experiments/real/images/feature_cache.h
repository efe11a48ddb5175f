// Caches the features of images by content. The name of a cache file is a hash of the image's bytes and of
// everything that determines its features. A copied or renamed image is therefore found, and a changed one
// is not confused with its former version.
#pragma once

#include <optional>
#include <string>

#include "experiments/real/images/features.h"

namespace rcme {

struct ImageFeatures {
  int width = 0, height = 0;  // of the image file, px
  Features features;
};

class FeatureCache {
 public:
  // Makes the folder. An empty name disables the cache.
  explicit FeatureCache(std::string folder);

  // Returns the features of an image file. They are read from the cache if they are there and undamaged,
  // otherwise computed and stored; a cache file is written completely or not at all. Throws InputError
  // (grey_image.h).
  ImageFeatures Get(const std::string& path, const DetectorOptions& options);

  int num_found() const { return num_found_; }  // found in the cache

 private:
  std::string folder_;
  int num_found_ = 0;
};

// Convert to and from the bytes of a cache file. UnpackFeatures returns nothing if they are damaged.
std::string PackFeatures(const ImageFeatures& image);
std::optional<ImageFeatures> UnpackFeatures(const std::string& bytes);

// Returns whether the detector can have produced these features: an undamaged file may still be malicious.
bool AreFeatures(const ImageFeatures& image, Detector detector);

}  // namespace rcme
