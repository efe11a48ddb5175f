#include "experiments/real_data/match_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <set>
#include <sstream>

#include "parameters/input_error.h"

namespace rcme {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> MatchFilesIn(const std::string& folder) {
  if (!fs::is_directory(folder)) {
    throw InputError(
        fmt::format("folder: '{}' is not a folder, seen from {}; give one with *.csv or *.csv.gz match files",
                    folder, fs::current_path().string()));
  }
  std::vector<fs::path> paths;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name != "INDEX.csv" && (name.ends_with(".csv") || name.ends_with(".csv.gz")))
      paths.push_back(entry.path());
  }
  if (paths.empty())
    throw InputError(fmt::format("folder: '{}' holds no *.csv or *.csv.gz match files", folder));
  std::sort(paths.begin(), paths.end());
  return paths;
}

// File names (without .csv, .csv.gz) whose true direction the index calls weak.
std::set<std::string> PairsWithWeakDirection(const fs::path& given_folder) {
  // Without a slash at the end, so that 'x/' too has its parent above it.
  const fs::path folder = (fs::absolute(given_folder) / "").lexically_normal().parent_path();
  std::set<std::string> weak;
  for (const fs::path& index : {folder / "INDEX.csv", folder.parent_path() / "INDEX.csv"}) {
    std::ifstream file(index);
    std::string line, field;
    std::map<std::string, size_t> column_of;
    for (bool is_first = true; std::getline(file, line); is_first = false) {
      std::vector<std::string> fields;
      for (std::istringstream row(line); std::getline(row, field, ',');) fields.push_back(field);
      if (is_first) {
        for (size_t c = 0; c < fields.size(); ++c) column_of.emplace(fields[c], c);
        if (!column_of.count("pair_id") || !column_of.count("t_gt_weak")) break;
      } else if (fields.size() > std::max(column_of["pair_id"], column_of["t_gt_weak"]) &&
                 fields[column_of["t_gt_weak"]] == "1") {
        weak.insert(fields[column_of["pair_id"]]);
      }
    }
  }
  return weak;
}

// FNV-1a over the numbers of a pair and its truth: changed data are another study.
std::uint64_t Digest(const MatchFile& file, bool is_direction_known, std::uint64_t hash) {
  const auto add = [&hash](double x) { hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0x100000001b3ULL; };
  for (const Camera& c : {file.camera1, file.camera2}) {
    for (const double x : {c.fx, c.fy, c.cx, c.cy, 1.0 * c.width, 1.0 * c.height}) add(x);
  }
  for (const Correspondence& m : file.matches) {
    for (const double x : {m.x1_px.x(), m.x1_px.y(), m.x2_px.x(), m.x2_px.y()}) add(x);
  }
  if (const std::optional<RelativePose>& pose = file.cam2_from_cam1_true) {
    for (const double x : pose->R.reshaped()) add(x);
    for (const double x : pose->t) add(x);
    add(is_direction_known ? 1.0 : 0.0);
  }
  return hash;
}

}  // namespace

int MatchFolderData::NumTrials(int trials) const {
  const auto product = static_cast<std::int64_t>(trials) * static_cast<std::int64_t>(pairs_.size());
  if (product <= std::numeric_limits<int>::max()) return static_cast<int>(product);
  throw InputError(fmt::format("trials: {} passes over {} pairs are more trials than {}", trials,
                               pairs_.size(), std::numeric_limits<int>::max()));
}

std::vector<std::pair<std::string, std::shared_ptr<const DataSource>>> LoadMatchFolder(
    const MatchFolderSettings& settings) {
  struct Group {
    std::vector<TrialData> pairs;
    std::uint64_t digest = 0xcbf29ce484222325ULL;
  };
  const std::set<std::string> weak = PairsWithWeakDirection(settings.folder);
  std::map<std::string, Group> groups;
  for (const fs::path& path : MatchFilesIn(settings.folder)) {
    MatchFile file = ReadMatchFile(path.string());
    Group& group = groups[file.scene];
    TrialData data;
    const std::string name = path.filename().string();
    data.origin = name;
    data.truth.cam2_from_cam1_true = file.cam2_from_cam1_true;
    data.truth.is_direction_known = weak.count(name.substr(0, name.find(".csv"))) == 0;
    group.digest = Digest(file, data.truth.is_direction_known, group.digest);
    data.problem = {std::move(file.matches), file.camera1, file.camera2, settings.sigma_px};
    group.pairs.push_back(std::move(data));
  }
  std::vector<std::pair<std::string, std::shared_ptr<const DataSource>>> sources;
  for (auto& [scene, group] : groups) {
    const std::string identity = fmt::format("{} files, digest {:016x}", group.pairs.size(), group.digest);
    sources.emplace_back(scene, std::make_shared<MatchFolderData>(std::move(group.pairs), identity));
  }
  return sources;
}

}  // namespace rcme
