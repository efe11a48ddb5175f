#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "experiments/real/sequences/layout_files.h"
#include "experiments/real/sequences/layouts.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

namespace fs = std::filesystem;

bool IsImageName(const fs::path& path) {
  static constexpr std::array<std::string_view, 10> kEndings = {".png", ".jpg", ".jpeg", ".tif", ".tiff",
                                                                ".bmp", ".pgm", ".ppm",  ".pbm", ".pnm"};
  std::string ending = path.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::ranges::find(kEndings, ending) != kEndings.end();
}

}  // namespace

std::vector<Sequence> ReadImageFolder(const DatasetOptions& options) {
  const fs::path folder(options.folder);
  CheckIsThere(folder, "give a folder with images");
  if (!fs::is_directory(folder)) throw InputError(fmt::format("{}: is not a folder", folder.string()));
  if (options.K.empty())
    throw InputError(fmt::format("--K: fx fy cx cy of the camera is needed, because {} holds only images",
                                 folder.string()));
  Sequence sequence;
  sequence.name = options.name.empty() ? FolderName(folder) : options.name;
  sequence.lens = MakeLens({options.K[0], options.K[1], options.K[2], options.K[3], 0, 0}, options.lens,
                           options.distortion, "--K, --lens, --distortion");
  sequence.note = "no truth: a folder of images has none";
  std::vector<fs::path> images;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (IsImageName(entry.path())) images.push_back(entry.path());
  }
  std::sort(images.begin(), images.end());
  for (const fs::path& image : images)
    sequence.frames.push_back({image.filename().string(), image.string(), Frame().time_s, std::nullopt});
  FinishSequence(options, folder, &sequence, OtherSizes::kSkipped);
  return {sequence};
}

}  // namespace rcme
