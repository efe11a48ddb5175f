#include "experiments/data/match_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <set>

#include "experiments/core/files/gzip_lines.h"
#include "experiments/core/text/field_text.h"
#include "experiments/data/truth_doubts.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"
#include "stats/fnv1a.h"

namespace rcme {
namespace {

namespace fs = std::filesystem;

// Limits, because all pairs of a folder are held in memory.
constexpr size_t kMaxPairs = 100'000;
constexpr size_t kMaxMatches = 10'000'000;

// Adds the pairs of `ids` whose true direction the index marks as weak.
void AddWeak(const fs::path& index, const std::set<std::string>& ids, std::set<std::string>* weak) {
  GzipLines lines(index.string(), {"index", "an index of pairs"});
  std::string_view line;
  if (!lines.Next(&line)) return;
  const std::vector<std::string> names = CsvFields(line);
  const auto id = static_cast<size_t>(std::ranges::find(names, "pair_id") - names.begin());
  const auto is_weak = static_cast<size_t>(std::ranges::find(names, "t_gt_weak") - names.begin());
  if (id == names.size() || is_weak == names.size()) return;
  while (lines.Next(&line)) {
    const std::vector<std::string> fields = CsvFields(line);
    if (fields.size() > std::max(id, is_weak) && fields[is_weak] == "1" && ids.count(fields[id]) > 0)
      weak->insert(fields[id]);
  }
}

// Adds the numbers of a pair and its truth to the digest: a study with other data is another study.
void AddMatches(const std::vector<Correspondence>& matches, Fnv1a* digest) {
  for (const Correspondence& m : matches) {
    for (const double x : {m.x1_px.x(), m.x1_px.y(), m.x2_px.x(), m.x2_px.y()}) digest->Add(x);
  }
}

void AddNumbers(const MatchFile& file, bool is_direction_known, Fnv1a* digest) {
  for (const Camera& c : {file.camera1, file.camera2}) {
    for (const double x : {c.fx, c.fy, c.cx, c.cy, 1.0 * c.width, 1.0 * c.height}) digest->Add(x);
  }
  AddMatches(file.matches, digest);
  if (const std::optional<RelativePose>& pose = file.cam2_from_cam1_true) {
    for (const double x : pose->R.reshaped()) digest->Add(x);
    for (const double x : pose->t) digest->Add(x);
    digest->Add(is_direction_known ? 1.0 : 0.0);
  }
  for (const double x : file.sigma_px) digest->Add(x);
  if (file.noise_level != 1.0) digest->Add(file.noise_level);
  if (file.truth_sd) {
    for (const double x : file.truth_sd->rotation_rad) digest->Add(x);
    for (const double x : file.truth_sd->translation) digest->Add(x);
  }
  if (file.prior) {
    for (const double x : ListPriorNumbers(*file.prior)) digest->Add(x);
  }
}

// Returns whether the uncertainty of the truth comes from the study rather than from the file.
bool IsTruthAssumed(const MatchFile& file, const PoseSd& truth) {
  return !truth.IsZero() && file.cam2_from_cam1_true && !file.truth_sd;
}

TruthSd AssumedSd(const MatchFile& file, const PoseSd& truth) {
  if (truth.position == 0.0) return SdOfMotion(truth, 1.0);
  if (file.baseline > 0.0) return SdOfMotion(truth, file.baseline);
  throw InputError(
      fmt::format("{}: header key '# baseline: ...', a length > 0, is missing; the study gives true "
                  "positions an error (truth_position_sd), which needs it",
                  file.path));
}

}  // namespace

std::string ExtractPairId(const fs::path& match_file) {
  const std::string name = match_file.filename().string();
  return name.substr(0, name.find(".csv"));
}

std::set<std::string> PairsWithWeakDirection(const fs::path& given_folder,
                                             const std::vector<fs::path>& files) {
  // Without a trailing slash, so that the parent of 'x/' is the folder above it.
  const fs::path folder = (fs::absolute(given_folder) / "").lexically_normal().parent_path();
  std::set<std::string> ids, weak;
  for (const fs::path& file : files) ids.insert(ExtractPairId(file));
  for (const fs::path& index : {folder / "INDEX.csv", folder.parent_path() / "INDEX.csv"}) {
    if (fs::exists(index)) AddWeak(index, ids, &weak);
  }
  return weak;
}

// Throws InputError if a.csv and a.csv.gz would be the same pair.
void CheckPairsStandOnce(const std::string& folder, const std::vector<fs::path>& paths) {
  std::map<std::string, fs::path> files;
  for (const fs::path& path : paths) {
    const auto [known, is_new] = files.emplace(ExtractPairId(path), path);
    if (is_new) continue;
    throw InputError(fmt::format("folder: '{}' holds the pair {} twice, as {} and {}; keep one of them",
                                 folder, known->first, known->second.filename().string(),
                                 path.filename().string()));
  }
}

std::vector<fs::path> MatchFilesIn(const std::string& folder) {
  if (!fs::is_directory(folder)) {
    throw InputError(
        fmt::format("folder: '{}' is not a folder, seen from {}; give one with *.csv or *.csv.gz match files",
                    folder, fs::current_path().string()));
  }
  std::vector<fs::path> paths;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name == "INDEX.csv" || !(name.ends_with(".csv") || name.ends_with(".csv.gz"))) continue;
    if (FindNotInLine(name) != std::string::npos) {
      throw InputError(
          fmt::format("folder: '{}' holds {}; give the file a name of UTF-8 without control characters",
                      folder, Quoted(name)));
    }
    if (paths.size() == kMaxPairs) {
      throw InputError(
          fmt::format("folder: '{}' holds too many pairs; at most {} are allowed", folder, kMaxPairs));
    }
    paths.push_back(entry.path());
  }
  if (paths.empty())
    throw InputError(fmt::format("folder: '{}' holds no *.csv or *.csv.gz match files", folder));
  std::sort(paths.begin(), paths.end());
  CheckPairsStandOnce(folder, paths);
  return paths;
}

void StatedSigmas::Add(const MatchFile& file) {
  const auto [first, is_new] = first_.emplace(file.scene, First{file.path, file.assumed_sigma_px});
  if (first->second.sigma_px == file.assumed_sigma_px) return;
  const auto describe = [](const std::optional<double>& sigma_px) {
    return sigma_px ? fmt::format("{} px", *sigma_px) : std::string("none");
  };
  throw InputError(fmt::format(
      "{}: sigma_px: {} differs from {} in {}, a pair of the same scene; give one noise level for "
      "all by --sigma",
      file.path, describe(file.assumed_sigma_px), describe(first->second.sigma_px), first->second.path));
}

void AddImageNames(const MatchFile& file, ImageNames* names) {
  if (!file.image1.empty() && !file.image2.empty())
    (*names)[fs::path(file.path).filename().string()] = {file.image1, file.image2};
}

ImageNames ImageNamesIn(const std::string& folder) {
  ImageNames names;
  for (const fs::path& path : MatchFilesIn(folder)) AddImageNames(ReadMatchFile(path.string()), &names);
  return names;
}

int MatchFolderData::NumTrials(int trials) const {
  const auto product = static_cast<std::int64_t>(trials) * static_cast<std::int64_t>(pairs_.size());
  if (product <= std::numeric_limits<int>::max()) return static_cast<int>(product);
  throw InputError(fmt::format("trials: {} passes over {} pairs are more trials than {}", trials,
                               pairs_.size(), std::numeric_limits<int>::max()));
}

std::vector<std::pair<std::string, std::shared_ptr<const DataSource>>> LoadMatchFolder(
    const MatchFolderSettings& settings, const std::function<void(const MatchFile&)>& visit) {
  struct Group {
    std::vector<TrialData> pairs;
    std::vector<double> noise_levels;
    std::vector<std::uint64_t> digests;
    Fnv1a digest;
    int num_with_truth_sd = 0, num_assumed = 0, num_in_doubt = 0;
  };
  const std::vector<fs::path> paths = MatchFilesIn(settings.folder);
  const std::set<std::string> weak = PairsWithWeakDirection(settings.folder, paths);
  std::map<std::string, Group> groups;
  size_t num_matches = 0;
  const Redraw redraw(settings.redraw);
  TruthDoubts doubts(settings.truth_in_doubt);
  InputWarnings warnings;
  for (const fs::path& path : paths) {
    MatchFile file = ReadMatchFile(path.string());
    if (visit) visit(file);
    warnings.Add(file.doubts);
    num_matches += file.matches.size();
    if (num_matches > kMaxMatches) {
      throw InputError(fmt::format("folder: '{}' holds too many matches; at most {} are allowed",
                                   settings.folder, kMaxMatches));
    }
    Group& group = groups[file.scene];
    TrialData data;
    data.origin = path.filename().string();
    data.truth.cam2_from_cam1_true = file.cam2_from_cam1_true;
    data.truth.is_direction_known = weak.count(ExtractPairId(path)) == 0;
    group.noise_levels.push_back(file.noise_level);
    group.num_with_truth_sd += file.truth_sd.has_value();
    if (IsTruthAssumed(file, settings.truth)) {
      file.truth_sd = AssumedSd(file, settings.truth);
      data.truth.is_direction_known &= !settings.truth.IsDirectionWeak(file.baseline);
      ++group.num_assumed;
    }
    data.truth.sd = file.truth_sd;
    AddNumbers(file, data.truth.is_direction_known, &group.digest);
    if (file.assumed_sigma_px && !settings.sigma_px) group.digest.Add(*file.assumed_sigma_px);
    for (const double score : file.scores) group.digest.Add(score);
    Fnv1a digest;
    AddMatches(file.matches, &digest);
    group.digests.push_back(digest.value());
    data.truth.is_in_doubt = doubts.Has(file.scene, ExtractPairId(path));
    if (data.truth.is_in_doubt) group.digest.Add(-1.0);
    group.num_in_doubt += data.truth.is_in_doubt;
    data.problem = MakeMotionProblem(std::move(file), settings.sigma_px);
    if (!settings.keeps_priors) data.problem.prior.reset();
    if (redraw.IsOn()) Redraw::Label(&data);
    group.pairs.push_back(std::move(data));
  }
  warnings.Print();
  doubts.RequireAnyFound(settings.folder);
  std::vector<std::pair<std::string, std::shared_ptr<const DataSource>>> sources;
  for (auto& [scene, group] : groups) {
    std::string identity = fmt::format("{} files, digest {:016x}", group.pairs.size(), group.digest.value());
    if (group.num_with_truth_sd > 0) identity += fmt::format(", truth_sd in {}", group.num_with_truth_sd);
    if (group.num_assumed > 0) identity += fmt::format(", truth_sd assumed in {}", group.num_assumed);
    if (group.num_in_doubt > 0) identity += fmt::format(", truth in doubt in {}", group.num_in_doubt);
    sources.emplace_back(
        scene, std::make_shared<MatchFolderData>(scene, std::move(group.pairs), std::move(group.noise_levels),
                                                 std::move(group.digests), identity, redraw));
  }
  return sources;
}

}  // namespace rcme
