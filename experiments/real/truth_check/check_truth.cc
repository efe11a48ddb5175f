#include "experiments/real/truth_check/check_truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "experiments/core/work/for_each_index.h"
#include "experiments/core/work/progress.h"
#include "experiments/data/match_file.h"
#include "experiments/data/match_folder.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

namespace fs = std::filesystem;

// Returns whether two files state the same motion, possibly with different numbers of digits.
constexpr double kSameMotionRad = 1e-3;

std::vector<std::string> NameFrontEnds(const std::vector<std::string>& folders) {
  std::vector<std::string> names;
  std::set<std::string> paths, last;
  for (const std::string& folder : folders) {
    const fs::path path = (fs::weakly_canonical(folder) / "").parent_path();
    if (!paths.insert(path.string()).second)
      throw InputError(fmt::format("'{}' is given twice; give a folder per front end", folder));
    names.push_back(path.filename().string());
    last.insert(names.back());
  }
  return last.size() == names.size() ? names : folders;
}

void RequireSamePair(const MatchFile& first, const MatchFile& other) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(
        fmt::format("{}: {} than {}, but the name is that of the same pair", other.path, what, first.path));
  };
  if (first.scene != other.scene) refuse("another scene");
  if (first.cam2_from_cam1_true.has_value() != other.cam2_from_cam1_true.has_value())
    refuse("another true motion");
  if (!first.cam2_from_cam1_true) return;
  const Vector5d difference = LocalCoordinates(*first.cam2_from_cam1_true, *other.cam2_from_cam1_true);
  if (difference.norm() > kSameMotionRad) refuse("another true motion");
}

// The match files of one pair, from the folders that have one.
struct PairFiles {
  std::string pair_id;
  std::vector<std::string> front_ends;  // names of the folders
  std::vector<std::string> paths;
  bool is_direction_weak = false;  // according to an INDEX.csv (match_folder.h)
};

std::vector<PairFiles> ListPairFiles(const std::vector<std::string>& folders) {
  const std::vector<std::string> names = NameFrontEnds(folders);
  std::map<std::string, PairFiles> pairs;
  for (size_t f = 0; f < folders.size(); ++f) {
    const std::vector<fs::path> paths = MatchFilesIn(folders[f]);
    const std::set<std::string> weak = PairsWithWeakDirection(folders[f], paths);
    for (const fs::path& path : paths) {
      const std::string id = ExtractPairId(path);
      PairFiles& pair = pairs[id];
      pair.pair_id = id;
      pair.front_ends.push_back(names[f]);
      pair.paths.push_back(path.string());
      pair.is_direction_weak |= weak.contains(id);
    }
  }
  std::vector<PairFiles> listed;
  for (auto& [id, pair] : pairs) listed.push_back(std::move(pair));
  return listed;
}

CheckedPair CheckPair(const PairFiles& files, const MotionEstimator& estimator,
                      const TruthCheckOptions& options) {
  CheckedPair pair;
  pair.pair_id = files.pair_id;
  std::optional<MatchFile> first;  // without its matches
  for (size_t f = 0; f < files.paths.size(); ++f) {
    MatchFile file = ReadMatchFile(files.paths[f]);
    std::ranges::copy(file.doubts, std::back_inserter(pair.camera_doubts));
    if (first) RequireSamePair(*first, file);
    if (file.cam2_from_cam1_true) {
      const GivenTruth truth{*file.cam2_from_cam1_true, file.truth_sd, !files.is_direction_weak};
      MotionProblem problem = MakeMotionProblem(file, options.sigma_px);
      problem.prior.reset();  // measurements of sensors are no evidence from matches
      pair.front_ends.push_back(
          WeighTruth(problem, truth, options.bounds, estimator, options.seed, files.paths.size()));
      pair.front_ends.back().front_end = files.front_ends[f];
    }
    if (first) continue;
    file.matches.clear();
    first = std::move(file);
  }
  pair.scene = first->scene;
  pair.has_truth = first->cam2_from_cam1_true.has_value();
  pair.verdict = JudgeTruth(pair.front_ends);
  return pair;
}

}  // namespace

std::vector<CheckedPair> CheckTruths(const std::vector<std::string>& folders,
                                     const MotionEstimator& estimator, const TruthCheckOptions& options) {
  const std::vector<PairFiles> files = ListPairFiles(folders);
  std::vector<CheckedPair> pairs;
  InputWarnings warnings;
  Progress progress("pairs", std::ssize(files), 0);
  MakeInOrder(
      std::ssize(files), options.num_threads,
      [&](std::int64_t i) { return CheckPair(files[static_cast<size_t>(i)], estimator, options); },
      [&](CheckedPair pair) {
        warnings.Add(pair.camera_doubts);
        pairs.push_back(std::move(pair));
        progress.Advance(1);
      });
  warnings.Print();
  return pairs;
}

}  // namespace rcme
