// What the quarter of a pixel by which OpenCV 4.6 misplaces SIFT's key points does to the regions of
// rcme_calibrated (results/sift_shift):
//   rcme_sift_shift rendered 60 > rendered.csv    sequences of so many frames, rendered as KITTI and EuRoC
//   lay them
//                                                 out, with the key points as features.cc gives them and as
//                                                 OpenCV does
//   rcme_sift_shift pairs FOLDER > pairs.csv      match files whose key points are as OpenCV gives them, as
//   they are
//                                                 and moved back
// A shift of all key points is one of the principal point the other way (of undistorted ones: in the corners
// of the rendered EuRoC camera the shift itself would be up to 1.6 times as much). Pairs share images: their
// exact intervals are too narrow.
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <charconv>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "estimator/estimator_registry.h"
#include "experiments/data/match_folder.h"
#include "experiments/real/sequences/layouts.h"
#include "experiments/real/sequences/make_pairs.h"
#include "stats/distributions.h"
#include "stats/intervals.h"
#include "tests/test_support/rendered_sequence.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

constexpr double kShiftPx = 0.25;

// "coverage" of the 95 % region, with its interval, and the median of the normalized squared errors (4.35
// expected), of the pairs with a known motion. Their principal points are moved by so much.
void PrintRows(const std::string& what, const std::vector<MatchFile>& files, double shift_px) {
  const auto estimator = MakeEstimator("rcme_calibrated");
  std::vector<double> nees;
  for (const MatchFile& file : files) {
    MotionProblem problem{file.matches, file.camera1, file.camera2, 0.5};
    for (Camera* camera : {&problem.camera1, &problem.camera2}) {
      camera->cx += shift_px;
      camera->cy += shift_px;
    }
    RandomStream rng({.seed = 1, .purpose = 4});
    const MotionEstimate e = estimator->Estimate(problem, rng);
    if (e.status != MotionStatus::kOk || !file.cam2_from_cam1_true) continue;
    const Vector5d error = LocalCoordinates(e.cam2_from_cam1, *file.cam2_from_cam1_true);
    nees.push_back(error.dot(e.pose_cov.llt().solve(error)));
  }
  if (nees.empty()) return;
  std::ranges::sort(nees);
  const auto num_covered =
      static_cast<int>(std::ranges::upper_bound(nees, ChiSquareQuantile(5, 0.95)) - nees.begin());
  const Interval interval = ExactBinomialInterval(num_covered, static_cast<int>(nees.size()));
  fmt::print("{},coverage,{:.4g},{:.4g},{:.4g},{}\n", what,
             1.0 * num_covered / static_cast<double>(nees.size()), interval.lower, interval.upper,
             nees.size());
  fmt::print("{},nees_median,{:.4g},,,{}\n", what, nees[nees.size() / 2], nees.size());
}

// Those whose direction the folder's index does not call weak.
std::vector<MatchFile> FilesIn(const std::string& folder) {
  const std::vector<std::filesystem::path> paths = MatchFilesIn(folder);
  const std::set<std::string> weak = PairsWithWeakDirection(folder, paths);
  std::vector<MatchFile> files;
  for (const std::filesystem::path& path : paths) {
    if (!weak.contains(ExtractPairId(path))) files.push_back(ReadMatchFile(path.string()));
  }
  return files;
}

void PrintPairs(const std::string& folder) {
  std::map<std::string, std::vector<MatchFile>> scenes;
  for (const MatchFile& file : FilesIn(folder)) scenes[file.scene].push_back(file);
  for (const auto& [scene, files] : scenes) {
    PrintRows(scene + ",moved_back", files, kShiftPx);
    PrintRows(scene + ",as_opencv_gives_them", files, 0.0);
  }
}

// The key frames of a sequence, chosen with the key points where they belong.
void PrintSequence(const std::string& layout, const std::vector<Sequence>& sequences,
                   const TempFolder& folder) {
  PairsOptions options;
  options.out = folder.Path("pairs_of_" + layout);
  {
    PairJournal journal(options.out, layout);
    MakePairsOfImages(sequences, options, &journal);
  }
  const std::vector<MatchFile> files = FilesIn(options.out);
  PrintRows(layout + ",moved_back", files, 0.0);
  PrintRows(layout + ",as_opencv_gives_them", files, -kShiftPx);
}

void PrintRendered(int num_frames) {
  const TempFolder folder;
  DatasetOptions kitti, euroc;
  kitti.folder = folder.Path("dataset");
  WriteKittiSequence(kitti.folder, "00", num_frames);
  PrintSequence("kitti", ReadKitti(kitti), folder);
  euroc.folder = folder.Path("MH_01_easy");
  RenderedCamera camera;
  camera.radtan = {-0.28, 0.07, 0.0004, -0.0003};
  WriteEurocSequence(euroc.folder, num_frames, camera);
  PrintSequence("euroc", ReadEuroc(euroc), folder);
}

}  // namespace
}  // namespace rcme

int main(int argc, char** argv) {
  const std::string_view what = argc == 3 ? argv[1] : "", text = argc == 3 ? argv[2] : "";
  int num_frames = 0;
  std::from_chars(text.data(), text.data() + text.size(), num_frames);
  const bool is_rendered = what == "rendered" && num_frames > 1;
  if (!is_rendered && what != "pairs") {
    fmt::print(stderr, "usage: rcme_sift_shift rendered FRAMES | pairs FOLDER > TABLE.csv\n");
    return 2;
  }
  fmt::print("pairs,key_points,quantity,value,lower,upper,n\n");
  if (is_rendered) {
    rcme::PrintRendered(num_frames);
  } else {
    rcme::PrintPairs(std::string(text));
  }
  return 0;
}
