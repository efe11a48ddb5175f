#include "experiments/real/sequences/layout_files.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "experiments/core/files/regular_file.h"
#include "experiments/data/match_header.h"
#include "experiments/real/images/grey_image.h"
#include "experiments/real/images/image_header.h"
#include "parameters/input_error.h"
#include "parameters/parameter.h"
#include "parameters/plain_text.h"

namespace rcme {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSpaces = " \t\r";
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // some editors write it first

const fs::path& CheckedPath(const fs::path& path, const std::string& origin) {
  CheckIsThere(path, origin);
  return path;
}

// Returns the header of an existing image, with size {0, 0} if it does not state one. A camera's JPEG has a
// preview before its frame header, and a TIFF often has its directory at the end; then the whole file is
// read.
ImageHeader HeaderOfImage(const Frame& frame, const std::string& sequence) {
  constexpr size_t kHeaderBytes = size_t{64} << 10;
  CheckIsThere(frame.path, fmt::format("it is an image of sequence {}", sequence));
  ImageHeader header = ReadImageHeader(RegularFile(frame.path, {"image", "an image"}).Read(kHeaderBytes));
  if (!header.format.empty() && (header.width < 1 || header.height < 1))
    header = ReadImageHeader(ReadImageBytes(frame.path));
  if (header.width < 1 || header.height < 1) header.width = header.height = 0;
  return header;
}

void CheckTimes(const Sequence& sequence, const fs::path& times) {
  for (size_t i = 1; i < sequence.frames.size(); ++i) {
    const Frame &before = sequence.frames[i - 1], &frame = sequence.frames[i];
    if (std::isnan(frame.time_s) || frame.time_s > before.time_s) continue;
    throw InputError(
        fmt::format("{}: the time of {}, {:.6f} s, is not after that of {}, {:.6f} s; times must grow",
                    times.string(), frame.name, frame.time_s, before.name, before.time_s));
  }
}

// Returns the size of each frame's image, from its header; 0 if the header is damaged.
using Size = std::pair<std::int64_t, std::int64_t>;
std::vector<Size> ReadSizes(const Sequence& sequence) {
  std::vector<Size> sizes;
  for (const Frame& frame : sequence.frames) {
    if (FindNotPlain(frame.name) != std::string::npos)
      throw InputError(fmt::format(
          "{}: the image's name is not allowed; give UTF-8 without control characters", Quoted(frame.path)));
    const ImageHeader header = HeaderOfImage(frame, sequence.name);
    sizes.emplace_back(header.width, header.height);
  }
  return sizes;
}

// Returns the image size to which K belongs: its centre is nearest to the principal point. Of sizes about
// equally near, the most frequent.
Size FindSizeOfK(const std::vector<Size>& sizes, const Camera& camera) {
  constexpr double kAboutAsNear = 0.02;
  std::map<Size, int> counts;
  for (const Size& size : sizes) ++counts[size];
  const auto measure = [&](const Size& size) {
    const auto width = static_cast<double>(size.first), height = static_cast<double>(size.second);
    return std::max(std::abs((camera.cx + 0.5) / width - 0.5), std::abs((camera.cy + 0.5) / height - 0.5));
  };
  std::pair<double, int> best;  // offset, -count
  Size found;
  for (const auto& [size, count] : counts) {
    if (size.first == 0) continue;
    const std::pair<double, int> rank(std::round(measure(size) / kAboutAsNear), -count);
    if (found.first > 0 && best <= rank) continue;
    best = rank;
    found = size;
  }
  return found;
}

void SkipOtherSize(const Size& size, const Camera& camera, Frame* frame) {
  const bool is_turned = size.first == camera.height && size.second == camera.width;
  frame->why_skipped =
      fmt::format("{}: is of {} x {} px; K is of images of {} x {} px: {}", frame->path, size.first,
                  size.second, camera.width, camera.height,
                  is_turned ? "rotate it back to the orientation of the sensor"
                            : "put images of another size into their own folder, with their K");
}

void CheckImages(Sequence* sequence, OtherSizes other_sizes) {
  Camera& camera = sequence->lens.camera;
  const std::vector<Size> sizes = ReadSizes(*sequence);
  const auto first = std::ranges::find_if(sizes, [](const Size& size) { return size.first > 0; });
  if (first == sizes.end() && camera.width == 0)
    throw InputError(fmt::format("{}: none of the sequence's {} images can be read",
                                 sequence->frames.front().path, sequence->frames.size()));
  const bool is_calibrated = camera.width > 0;
  if (!is_calibrated) {
    const Size size = other_sizes == OtherSizes::kSkipped ? FindSizeOfK(sizes, camera) : *first;
    camera.width = static_cast<int>(std::min<std::int64_t>(size.first, 1'000'000));
    camera.height = static_cast<int>(std::min<std::int64_t>(size.second, 1'000'000));
  }
  for (size_t i = 0; i < sizes.size(); ++i) {
    Frame& frame = sequence->frames[i];
    if (sizes[i].first == 0 || sizes[i] == Size(camera.width, camera.height)) continue;
    if (other_sizes == OtherSizes::kRefused) {
      throw InputError(fmt::format(
          "{}: is of {} x {} px; the sequence's images must be of {} x {} px{}", frame.path, sizes[i].first,
          sizes[i].second, camera.width, camera.height,
          is_calibrated
              ? ", as its calibration says"
              : fmt::format(" as {}", sequence->frames[static_cast<size_t>(first - sizes.begin())].path)));
    }
    SkipOtherSize(sizes[i], camera, &frame);
  }
}

}  // namespace

TableFile::TableFile(const fs::path& path, const std::string& origin, Separator separator, int max_rows)
    : lines_(CheckedPath(path, origin).string(), {"file", "a file"}),
      separator_(separator),
      rows_left_(max_rows) {}

bool TableFile::Next() {
  for (std::string_view line; lines_.Next(&line);) {
    if (lines_.line_number() == 1 && line.starts_with(kByteOrderMark))
      line.remove_prefix(kByteOrderMark.size());
    const size_t begin = line.find_first_not_of(kSpaces);
    if (begin == std::string_view::npos || line[begin] == '#') continue;
    if (rows_left_-- == 0) Fail("the file has more rows than data sets have; give a part of it");
    fields_ = separator_ == Separator::kComma ? SplitAtCommas(line) : SplitAtBlanks(line);
    return true;
  }
  return false;
}

void TableFile::Need(size_t num_fields, const std::string& what) const {
  if (fields_.size() < num_fields)
    Fail(fmt::format("{} fields; {} are needed: {}", fields_.size(), num_fields, what));
}

double TableFile::Number(size_t i) const {
  double number = 0.0;
  if (!ParseReal(fields_.at(i), &number)) Fail(fmt::format("{} is not a finite number", Quoted(fields_[i])));
  return number;
}

void CheckIsThere(const fs::path& path, const std::string& origin) {
  std::error_code ignored;
  if (!fs::exists(path, ignored))
    throw InputError(fmt::format("{}: is not there; {}", path.string(), origin));
}

std::string FolderName(const fs::path& folder) {
  return (fs::absolute(folder) / "").lexically_normal().parent_path().filename().string();
}

std::vector<fs::path> SequenceFolders(const DatasetOptions& options, const std::string& marker,
                                      const std::string& origin) {
  const fs::path root(options.folder);
  CheckIsThere(root, "give the folder of the data set");
  if (!fs::is_directory(root)) throw InputError(fmt::format("{}: is not a folder", root.string()));
  std::vector<fs::path> folders;
  if (fs::exists(root / marker)) folders.push_back(root);
  if (folders.empty()) {
    for (const fs::directory_entry& entry : fs::directory_iterator(root)) {
      if (entry.is_directory() && fs::exists(entry.path() / marker)) folders.push_back(entry.path());
    }
  }
  if (folders.empty()) CheckIsThere(root / marker, origin);
  std::sort(folders.begin(), folders.end());
  if (options.only.empty()) return folders;
  std::vector<fs::path> chosen;
  for (const std::string& name : options.only) {
    const auto found =
        std::ranges::find_if(folders, [&](const fs::path& folder) { return FolderName(folder) == name; });
    if (found == folders.end()) {
      std::vector<std::string> names;
      for (const fs::path& folder : folders) names.push_back(FolderName(folder));
      throw InputError(fmt::format("--sequence: {} is not in {}; there are {}", Quoted(name), root.string(),
                                   fmt::join(names, ", ")));
    }
    chosen.push_back(*found);
  }
  return chosen;
}

Eigen::Matrix3d RotationFromFields(const TableFile& table, size_t w, size_t x, size_t y, size_t z) {
  const Eigen::Quaterniond q(table.Number(w), table.Number(x), table.Number(y), table.Number(z));
  if (!(std::abs(q.norm() - 1.0) < 1e-2))
    table.Fail(fmt::format("a quaternion of length {:.4g}, not 1", q.norm()));
  return q.normalized().toRotationMatrix();
}

void FinishSequence(const DatasetOptions& options, const fs::path& times, Sequence* sequence,
                    OtherSizes other_sizes) {
  if (options.max_frames > 0 && sequence->frames.size() > static_cast<size_t>(options.max_frames))
    sequence->frames.resize(static_cast<size_t>(options.max_frames));
  if (sequence->frames.size() < 2)
    throw InputError(
        fmt::format("{}: names {} images; a pair needs two", times.string(), sequence->frames.size()));
  CheckTimes(*sequence, times);
  CheckImages(sequence, other_sizes);
}

}  // namespace rcme
