#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "experiments/data/data_source.h"
#include "experiments/data/match_file.h"
#include "experiments/data/redraw.h"

namespace rcme {

// What a `data:` block says of a folder of match files.
struct MatchFolderSettings {
  std::string folder;     // relative to the working directory
  double sigma_px = 0.5;  // the noise level that the estimators assume
  PoseSd truth = {};      // of the poses behind the true motions of files without truth_sd
  // A list of pairs whose truth is in doubt (truth_doubts.h), seen as the folder; empty: none is.
  std::string truth_in_doubt = {};
  RedrawSettings redraw = {};
};

// The pairs of one scene of a folder of match files; trial t is file t mod (number of files), each pass with
// its own random samples, and noise and wrong matches where these are drawn anew. Pairs of one scene share
// images: they are not independent.
class MatchFolderData : public DataSource {
 public:
  MatchFolderData(std::string scene, std::vector<TrialData> pairs, std::vector<double> noise_levels,
                  std::string identity, Redraw redraw)
      : scene_(std::move(scene)),
        pairs_(std::move(pairs)),
        noise_levels_(std::move(noise_levels)),
        identity_(std::move(identity)),
        redraw_(std::move(redraw)) {}

  int NumTrials(int trials) const override;
  TrialData Make(const StreamName& trial_name) const override {
    const size_t i = trial_name.trial % pairs_.size();
    return redraw_.IsOn() ? redraw_.Draw(pairs_[i], trial_name, noise_levels_[i]) : pairs_[i];
  }
  std::string Identity() const override { return identity_; }
  std::optional<std::string> SharedScene() const override { return scene_; }

 private:
  std::string scene_;
  std::vector<TrialData> pairs_;
  std::vector<double> noise_levels_;
  std::string identity_;
  Redraw redraw_;
};

// The match files of a folder in the order of names. Throws InputError: no such folder, none in it, too many.
std::vector<std::filesystem::path> MatchFilesIn(const std::string& folder);

// The two images of each match file of a folder that names them, by the file's name (TrialData::origin).
// Pairs of one scene with an equal name share the image.
using ImageNames = std::map<std::string, std::pair<std::string, std::string>>;
ImageNames ImageNamesIn(const std::string& folder);

// The name of a pair in an index: that of its file without the ending.
std::string ExtractPairId(const std::filesystem::path& match_file);

// Of these files of a folder the pairs whose true direction an INDEX.csv in it or above it calls weak.
std::set<std::string> PairsWithWeakDirection(const std::filesystem::path& given_folder,
                                             const std::vector<std::filesystem::path>& files);

// Reads every *.csv and *.csv.gz of the folder in the order of names, grouped by the header's scene. An
// INDEX.csv in the folder or above it may mark pairs whose true direction is not to be scored (columns
// pair_id, t_gt_weak = 1).
std::vector<std::pair<std::string, std::shared_ptr<const DataSource>>> LoadMatchFolder(
    const MatchFolderSettings& settings);

}  // namespace rcme
