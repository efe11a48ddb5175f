#include "experiments/data/grey_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <string_view>

#include "experiments/base/regular_file.h"
#include "experiments/data/image_header.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

constexpr size_t kMaxImageBytes = size_t{256} << 20;
// SIFT takes some 230 bytes per pixel: 3.9 GB for the largest image.
constexpr std::int64_t kMaxPixels = std::int64_t{4096} * 4096;

// The size that is to be unpacked is known before anything is: a small file may hold a huge image.
void CheckHeader(const std::string& bytes, const std::string& path) {
  const ImageHeader header = ReadImageHeader(bytes);
  if (header.format.empty())
    throw InputError(fmt::format("{}: is not a PNG, JPEG, TIFF, BMP or PNM image; convert it", path));
  if (header.width < 1 || header.height < 1)
    throw InputError(fmt::format("{}: the header of the {} image is damaged", path, header.format));
  if (header.width > kMaxPixels / header.height) {
    throw InputError(
        fmt::format("{}: {} x {} px are too many; at most {} are allowed (such as 4096 x 4096): scale "
                    "the image down, and its K",
                    path, header.width, header.height, kMaxPixels));
  }
}

// Decoders fill what is missing of PNG and JPEG with grey: whether their end is there is seen here. Behind it
// may be what a camera adds.
void CheckIsWhole(const std::string& bytes, const std::string& path) {
  constexpr size_t kLastBytes = 4096;
  const std::string_view all(bytes), last = all.substr(all.size() - std::min(all.size(), kLastBytes));
  const bool is_png = all.starts_with("\x89PNG"), is_jpeg = all.starts_with("\xFF\xD8");
  if ((is_png && last.find("IEND") == std::string_view::npos) ||
      (is_jpeg && last.find("\xFF\xD9") == std::string_view::npos))
    throw InputError(fmt::format("{}: the image is damaged: it ends early", path));
}

}  // namespace

std::string ReadImageBytes(const std::string& path) {
  std::string bytes = RegularFile(path, {"image", "an image"}).Read(kMaxImageBytes + 1);
  if (bytes.size() > kMaxImageBytes)
    throw InputError(fmt::format("{}: larger than an image can be ({} MiB)", path, kMaxImageBytes >> 20));
  return bytes;
}

GreyImage UnpackImage(std::string bytes, const std::string& path) {
  CheckHeader(bytes, path);
  CheckIsWhole(bytes, path);
  cv::Mat image;
  try {
    // As the sensor has it, which is what K is of: not turned as the camera was held.
    image = cv::imdecode(cv::Mat(1, static_cast<int>(bytes.size()), CV_8UC1, bytes.data()),
                         cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception& error) {
    throw InputError(fmt::format("{}: the image is damaged ({})", path, error.err));
  }
  if (image.empty()) throw InputError(fmt::format("{}: the image is damaged", path));
  const cv::Mat rows = image.isContinuous() ? image : image.clone();
  return {rows.cols, rows.rows, {rows.datastart, rows.dataend}};
}

}  // namespace rcme
