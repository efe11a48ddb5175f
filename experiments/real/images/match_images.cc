#include "experiments/real/images/match_images.h"

#include <fmt/format.h>

#include "experiments/data/camera_plausibility.h"
#include "experiments/real/images/feature_cache.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

Camera MakeImageCamera(const ImageFeatures& image, const std::vector<double>& k, const std::string& name) {
  const Camera camera{k.at(0), k.at(1), k.at(2), k.at(3), image.width, image.height};
  if (!camera.IsValid()) throw InputError(fmt::format("{}: K is singular; fx and fy must be > 0", name));
  return camera;
}

}  // namespace

MatchFile MatchImages(const MatchImagesOptions& options) {
  FeatureCache no_cache("");
  const ImageFeatures image1 = no_cache.Get(options.image1, options.detector);
  const ImageFeatures image2 = no_cache.Get(options.image2, options.detector);
  MatchFile file;
  file.camera1 = MakeImageCamera(image1, options.K1, "--K1");
  file.camera2 = MakeImageCamera(image2, options.K2.empty() ? options.K1 : options.K2, "--K2");
  for (const FeatureMatch& match : MatchFeatures(image1.features, image2.features, options.matcher)) {
    const KeyPoint& p1 = image1.features.key_points[match.at1];
    const KeyPoint& p2 = image2.features.key_points[match.at2];
    file.matches.push_back({{p1.x_px, p1.y_px}, {p2.x_px, p2.y_px}});
    if (options.has_scores) file.scores.push_back(match.ratio);
    file.sigma_px.push_back(
        SigmaOfMatch(options.detector.detector, p1, p2, image1.features.scale, image2.features.scale));
  }
  if (options.has_scores) file.better_score = BetterScore::kLower;
  file.doubts = FindPairDoubts(file.camera1, file.camera2, file.matches,
                               {"--K1", options.K2.empty() ? "--K1" : "--K2"});
  return file;
}

}  // namespace rcme
