#include "experiments/real/images/grey_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string_view>

#include "experiments/core/files/regular_file.h"
#include "experiments/real/images/image_decoder.h"
#include "experiments/real/images/image_header.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

constexpr size_t kMaxImageBytes = size_t{1} << 30;
// Limit for a file: .5 GB with 16 bits.
constexpr std::int64_t kMaxFilePixels = std::int64_t{1} << 28;
// Limit for detection: SIFT takes some 230 bytes per pixel, 3.9 GB for the largest image.
constexpr std::int64_t kMaxPixels = std::int64_t{4096} * 4096;

// Checks the size before anything is decoded, because a small file may hold a huge image.
void CheckHeader(const std::string& bytes, const std::string& path) {
  const ImageHeader header = ReadImageHeader(bytes);
  if (header.format.empty())
    throw InputError(fmt::format("{}: is not a PNG, JPEG, TIFF, BMP or PNM image; convert it", path));
  if (header.width < 1 || header.height < 1)
    throw InputError(fmt::format("{}: the header of the {} image is damaged", path, header.format));
  if (header.width > kMaxFilePixels / header.height) {
    throw InputError(fmt::format(
        "{}: {} x {} px are too many; at most {} are read (such as 16384 x 16384): scale the image "
        "down, and its K",
        path, header.width, header.height, kMaxFilePixels));
  }
}

// Checks that PNG and JPEG files have their end, because decoders fill missing parts with grey. Some cameras
// append data after the end.
void CheckIsWhole(const std::string& bytes, const std::string& path) {
  constexpr size_t kLastBytes = 4096;
  const std::string_view all(bytes), last = all.substr(all.size() - std::min(all.size(), kLastBytes));
  const bool is_png = all.starts_with("\x89PNG"), is_jpeg = all.starts_with("\xFF\xD8");
  if ((is_png && last.find("IEND") == std::string_view::npos) ||
      (is_jpeg && last.find("\xFF\xD9") == std::string_view::npos))
    throw InputError(fmt::format("{}: the image is damaged: it ends early", path));
}

// Reduces 16 bits to 8, so that an image from a 12-bit sensor is as bright as one in an 8-bit file.
cv::Mat TakeUpperBits(const cv::Mat& image) {
  if (image.depth() == CV_8U) return image;
  double greatest = 0.0;
  cv::minMaxIdx(image, nullptr, &greatest);
  int num_bits = 8;
  while (greatest >= static_cast<double>(1 << num_bits)) num_bits += 2;
  cv::Mat upper(image.rows, image.cols, CV_8UC1);
  for (int y = 0; y < image.rows; ++y) {
    const auto* row = image.ptr<std::uint16_t>(y);
    std::transform(row, row + image.cols, upper.ptr(y),
                   [&](std::uint16_t value) { return static_cast<std::uint8_t>(value >> (num_bits - 8)); });
  }
  return upper;
}

int FindScale(std::int64_t width, std::int64_t height) {
  int scale = 1;
  while ((width / scale) * (height / scale) > kMaxPixels) ++scale;
  return scale;
}

cv::Mat ScaleDown(const cv::Mat& image, int scale) {
  if (scale == 1) return image;
  const cv::Size size(image.cols / scale, image.rows / scale);
  cv::Mat small;
  cv::resize(image(cv::Rect(0, 0, scale * size.width, scale * size.height)), small, size, 0.0, 0.0,
             cv::INTER_AREA);
  return small;
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
    // In the orientation of the sensor, to which K refers, not in that of the camera.
    image = DecodeImage(cv::Mat(1, static_cast<int>(bytes.size()), CV_8UC1, bytes.data()),
                        cv::IMREAD_GRAYSCALE | cv::IMREAD_ANYDEPTH | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception& error) {
    throw InputError(fmt::format("{}: the image is damaged ({})", path, error.err));
  }
  if (image.empty()) throw InputError(fmt::format("{}: the image is damaged", path));
  if (image.type() != CV_8UC1 && image.type() != CV_16UC1)
    throw InputError(fmt::format("{}: its numbers are not whole ones of 8 or 16 bits; convert it", path));
  const int scale = FindScale(image.cols, image.rows);
  const cv::Mat small = ScaleDown(TakeUpperBits(image), scale);
  const cv::Mat rows = small.isContinuous() ? small : small.clone();
  return {rows.cols, rows.rows, {rows.datastart, rows.dataend}, scale, image.cols, image.rows};
}

}  // namespace rcme
