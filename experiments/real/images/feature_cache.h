// Features of images that were seen before, by content: the name of a file in the cache is a hash of the
// image's bytes and of all that decides what is found in them. A copied or renamed image is found again, a
// changed one is not taken for what it was.
#pragma once

#include <optional>
#include <string>

#include "experiments/real/images/features.h"

namespace rcme {

struct ImageFeatures {
  int width = 0, height = 0;  // of the file, px
  Features features;
};

class FeatureCache {
 public:
  // Makes the folder. Empty: nothing is kept.
  explicit FeatureCache(std::string folder);

  // Those of an image file, from the cache where they are there and undamaged; else they are found and kept:
  // a file of the cache is written whole or not at all. Throws InputError (grey_image.h).
  ImageFeatures Get(const std::string& path, const DetectorOptions& options);

  int num_found() const { return num_found_; }  // in the cache

 private:
  std::string folder_;
  int num_found_ = 0;
};

// As the bytes of a file of the cache, and back; nothing where they are damaged.
std::string PackFeatures(const ImageFeatures& image);
std::optional<ImageFeatures> UnpackFeatures(const std::string& bytes);

// Whether the detector can have found these: a file that is whole may have been made to harm.
bool AreFeatures(const ImageFeatures& image, Detector detector);

}  // namespace rcme
