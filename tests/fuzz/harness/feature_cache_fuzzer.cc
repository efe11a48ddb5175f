#include <algorithm>
#include <cmath>
#include <cstring>

#include "experiments/real/images/feature_cache.h"
#include "tests/fuzz/harness/only_input_error.h"

namespace rcme {
namespace {

// Takes a value of the input, zeros where it has ended.
template <typename T>
T Take(std::string_view* input) {
  T value{};
  const size_t size = std::min(sizeof(T), input->size());
  std::memcpy(&value, input->data(), size);
  input->remove_prefix(size);
  return value;
}

// Two bytes of size, the number of key points and of descriptor bytes beyond (or below) what these need,
// whether they are bits, then key points of three bytes, sixteenths of a pixel or a number that is none, and
// the descriptors.
ImageFeatures TakeFeatures(std::string_view input, Detector detector) {
  ImageFeatures image;
  image.width = Take<std::int8_t>(&input);
  image.height = Take<std::int8_t>(&input);
  const size_t num_points = Take<std::uint8_t>(&input) % 16;
  const auto excess = Take<std::int8_t>(&input);
  image.features.is_binary = Take<std::uint8_t>(&input) % 2 == 1;
  const auto take_number = [&input] {
    const auto byte = Take<std::int8_t>(&input);
    return byte == -128 ? std::nanf("") : byte == -127 ? INFINITY : static_cast<float>(byte) / 4.0f;
  };
  for (size_t i = 0; i < num_points; ++i)
    image.features.key_points.push_back({take_number(), take_number(), take_number()});
  const auto num_bytes = static_cast<std::ptrdiff_t>(num_points * CountDescriptorBytes(detector)) + excess;
  image.features.descriptors.resize(static_cast<size_t>(std::max<std::ptrdiff_t>(0, num_bytes)));
  std::copy_n(input.begin(), std::min(input.size(), image.features.descriptors.size()),
              image.features.descriptors.begin());
  return image;
}

// What is done with features: each match has a noise level that is a number.
void Match(const Features& features1, const Features& features2, Detector detector) {
  for (const FeatureMatch& match : MatchFeatures(features1, features2, {})) {
    const double sigma_px =
        SigmaOfMatch(detector, features1.key_points.at(match.at1), features2.key_points.at(match.at2));
    if (!(sigma_px > 0.0 && std::isfinite(sigma_px))) std::abort();
  }
}

}  // namespace
}  // namespace rcme

// A file of the cache as it is; and one with a true hash, of which some fields are wrong. What is taken for
// features of the detector is matched with its own key points in another order.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  using namespace rcme;
  if (size == 0) return 0;
  const Detector detector = DetectorNames()[data[0] % DetectorNames().size()].second;
  const std::string_view input(reinterpret_cast<const char*>(data + 1), size - 1);
  return OnlyInputError([&] {
    UnpackFeatures(std::string(input));
    const std::string file = PackFeatures(TakeFeatures(input, detector));
    const std::optional<ImageFeatures> image = UnpackFeatures(file);
    if (!image || PackFeatures(*image) != file) std::abort();
    if (!AreFeatures(*image, detector)) return;
    Features other = image->features;
    std::ranges::reverse(other.key_points);
    Match(image->features, other, detector);
  });
}
