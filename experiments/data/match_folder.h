#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "experiments/data/data_source.h"
#include "experiments/data/match_file.h"
#include "experiments/data/redraw.h"

namespace rcme {

// The settings of a folder of match files in a `data:` block.
struct MatchFolderSettings {
  std::string folder;                   // relative to the working directory
  std::optional<double> sigma_px = {};  // noise level that the estimators assume, in place of the files' own
  PoseSd truth = {};                    // of the true poses, for files without truth_sd
  // A list of pairs whose truth is in doubt (truth_doubts.h), relative to the working directory; empty:
  // none.
  std::string truth_in_doubt = {};
  RedrawSettings redraw = {};
  bool keeps_priors = true;  // uses priors of the motion that files state
};

// The pairs of one scene of a folder of match files. Trial t has file t mod (number of files). Each pass
// over the files has its own random samples, and its own noise and wrong matches if these are redrawn. Pairs
// of one scene share images, so they are not independent.
class MatchFolderData : public DataSource {
 public:
  MatchFolderData(std::string scene, std::vector<TrialData> pairs, std::vector<double> noise_levels,
                  std::vector<std::uint64_t> digests, std::string identity, Redraw redraw)
      : scene_(std::move(scene)),
        pairs_(std::move(pairs)),
        noise_levels_(std::move(noise_levels)),
        digests_(std::move(digests)),
        identity_(std::move(identity)),
        redraw_(std::move(redraw)) {}

  int NumTrials(int trials) const override;
  TrialData Make(const StreamName& trial_name) const override {
    const size_t i = trial_name.trial % pairs_.size();
    return redraw_.IsOn() ? redraw_.Draw(pairs_[i], trial_name, noise_levels_[i]) : pairs_[i];
  }
  std::string Identity() const override { return identity_; }
  std::optional<std::string> SharedScene() const override { return scene_; }
  // One per pair: the digest of the coordinates of its matches.
  std::vector<std::uint64_t> ProblemNames() const override { return digests_; }

 private:
  std::string scene_;
  std::vector<TrialData> pairs_;
  std::vector<double> noise_levels_;
  std::vector<std::uint64_t> digests_;
  std::string identity_;
  Redraw redraw_;
};

// Lists the match files of a folder, ordered by name. Throws InputError if the folder does not exist, has no
// match files or has too many.
std::vector<std::filesystem::path> MatchFilesIn(const std::string& folder);

// Requires that the match files of a scene state the same noise level, for commands that assume one for all
// pairs of a scene.
class StatedSigmas {
 public:
  // Throws InputError if an earlier file of the scene states another level.
  void Add(const MatchFile& file);

 private:
  struct First {
    std::string path;
    std::optional<double> sigma_px;
  };
  std::map<std::string, First> first_;  // by scene
};

// The names of the two images of each match file that states them, by file name (TrialData::origin). Pairs
// of one scene with an equal name share the image.
using ImageNames = std::map<std::string, std::pair<std::string, std::string>>;
void AddImageNames(const MatchFile& file, ImageNames* names);
ImageNames ImageNamesIn(const std::string& folder);

// Returns the name of a pair in an index: the file name without its ending.
std::string ExtractPairId(const std::filesystem::path& match_file);

// Returns those pairs whose true direction is marked as weak by an INDEX.csv in the folder or above it.
std::set<std::string> PairsWithWeakDirection(const std::filesystem::path& given_folder,
                                             const std::vector<std::filesystem::path>& files);

// Reads every *.csv and *.csv.gz of the folder, ordered by name and grouped by the scene in the header. An
// INDEX.csv in the folder or above it may mark pairs whose true direction is not scored (columns pair_id,
// t_gt_weak = 1). Calls `visit` with each file as it was read.
std::vector<std::pair<std::string, std::shared_ptr<const DataSource>>> LoadMatchFolder(
    const MatchFolderSettings& settings, const std::function<void(const MatchFile&)>& visit = {});

}  // namespace rcme
