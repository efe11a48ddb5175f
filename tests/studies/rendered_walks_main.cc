// Image sequences with exact truth for results/robust (planted_rendered), as KITTI odometry lays them out:
//   rcme_rendered_walks FOLDER SETS FRAMES
// Each set is a part of a walk through a hall (tests/test_support/rendered_sequence.h) with a texture of its
// own, in images of 640 x 480 px.
#include <fmt/format.h>

#include <charconv>
#include <string>
#include <string_view>

#include "tests/test_support/rendered_sequence.h"

namespace rcme {
namespace {

void WriteWalks(const std::string& folder, int num_sets, int num_frames) {
  RenderedCamera camera;
  camera.camera = {520.0, 524.0, 317.1, 243.7, 640, 480};
  for (int set = 0; set < num_sets; ++set) {
    const RenderedWalk walk{
        .first_frame = 4 * set % 80, .num_frames = num_frames, .texture = static_cast<std::uint32_t>(set)};
    WriteKittiSequence(folder, fmt::format("{:02}", set), walk, camera);
  }
}

int ReadCount(std::string_view text) {
  int count = 0;
  std::from_chars(text.data(), text.data() + text.size(), count);
  return count;
}

}  // namespace
}  // namespace rcme

int main(int argc, char** argv) {
  const int num_sets = argc == 4 ? rcme::ReadCount(argv[2]) : 0;
  const int num_frames = argc == 4 ? rcme::ReadCount(argv[3]) : 0;
  if (num_sets < 1 || num_frames < 2) {
    fmt::print(stderr, "usage: rcme_rendered_walks FOLDER SETS FRAMES\n");
    return 2;
  }
  rcme::WriteWalks(argv[1], num_sets, num_frames);
  return 0;
}
