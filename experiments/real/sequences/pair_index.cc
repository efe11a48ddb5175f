#include "experiments/real/sequences/pair_index.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "experiments/core/files/file_output.h"
#include "experiments/core/files/owner_lock.h"
#include "experiments/core/files/regular_file.h"
#include "experiments/core/text/columns.h"
#include "experiments/core/text/field_text.h"
#include "experiments/real/sequences/key_frame_gate.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kJournalKind = "rcme pairs 1";
constexpr size_t kMaxJournalBytes = size_t{1} << 30;

// Reads a number of the journal; NaN for null.
double RealIn(const Json& row, const char* key) {
  const Json& value = row.at(key);
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

Json AsJson(const PairRow& row) {
  return {{"pair_id", row.pair_id},
          {"scene", row.scene},
          {"image1", row.image1},
          {"image2", row.image2},
          {"reason", row.reason},
          {"num_matches", row.num_matches},
          {"num_inliers", row.num_inliers ? Json(*row.num_inliers) : Json()},
          {"time1_s", JsonNumber(row.time1_s)},
          {"time2_s", JsonNumber(row.time2_s)},
          {"parallax_deg", JsonNumber(row.parallax_deg)},
          {"rotation_deg", JsonNumber(row.rotation_deg)},
          {"baseline", JsonNumber(row.baseline)},
          {"is_direction_weak", row.is_direction_weak}};
}

PairRow RowFrom(const Json& json) {
  PairRow row;
  row.pair_id = json.at("pair_id");
  row.scene = json.at("scene");
  row.image1 = json.at("image1");
  row.image2 = json.at("image2");
  row.reason = json.at("reason");
  row.num_matches = json.at("num_matches");
  if (const Json& inliers = json.at("num_inliers"); !inliers.is_null()) row.num_inliers = inliers.get<int>();
  row.time1_s = RealIn(json, "time1_s");
  row.time2_s = RealIn(json, "time2_s");
  row.parallax_deg = RealIn(json, "parallax_deg");
  row.rotation_deg = RealIn(json, "rotation_deg");
  row.baseline = RealIn(json, "baseline");
  row.is_direction_weak = json.at("is_direction_weak");
  return row;
}

void CheckHoldsNoOtherPairs(const fs::path& folder) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (!name.ends_with(".csv") && !name.ends_with(".csv.gz")) continue;
    throw InputError(
        fmt::format("--out: {} holds {}, which this command did not write; give a new or empty folder",
                    folder.string(), name));
  }
}

}  // namespace

PairJournal::PairJournal(const std::string& folder, const std::string& identity)
    : path_((fs::path(folder) / "pairs.journal").string()) {
  MakeResultFolder(folder);
  const bool is_new = !fs::exists(path_);
  if (is_new) CheckHoldsNoOtherPairs(folder);
  std::optional<RegularFile> old;
  if (!is_new)
    old.emplace(path_, FileKind{"journal", "a journal"});  // refuses a pipe, whose opening would wait
  file_ = std::fopen(path_.c_str(), "ab");
  if (!file_) throw InputError(fmt::format("{}: cannot be written: {}", path_, std::strerror(errno)));
  if (!LockOwn(path_, fileno(file_))) {
    std::fclose(std::exchange(file_, nullptr));
    throw InputError(fmt::format(
        "--out: another process makes pairs in {}; wait until it ends, or give another folder", folder));
  }
  size_t num_bytes = 0;
  if (old) {
    const std::string text = old->Read(kMaxJournalBytes);
    num_bytes = text.rfind('\n') + 1;  // npos + 1 is 0
    Read(text.substr(0, num_bytes), identity);
    fs::resize_file(path_, num_bytes);
    if (num_bytes == 0) CheckHoldsNoOtherPairs(folder);
  }
  if (num_bytes == 0) AddLine(Json{{"kind", kJournalKind}, {"identity", identity}}.dump());
  num_before_ = static_cast<int>(rows_.size());
}

PairJournal::~PairJournal() {
  if (file_) std::fclose(file_);
}

void PairJournal::Read(const std::string& text, const std::string& identity) {
  const fs::path folder = fs::path(path_).parent_path();
  int number = 0;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = text.find('\n', begin);
    ++number;
    try {
      const Json json = Json::parse(text.substr(begin, end - begin));
      if (number == 1) {
        if (json.at("kind") != kJournalKind || json.at("identity") != identity) {
          throw InputError(
              fmt::format("--out: {} holds pairs of other images or made with other options; give another "
                          "folder, or remove that one",
                          folder.string()));
        }
      } else if (json.contains("damaged")) {
        damaged_.push_back({json.at("scene"), json.at("damaged"), json.at("message")});
      } else {
        PairRow row = RowFrom(json);
        if (row.reason != kKeptPair || fs::exists(folder / (row.pair_id + ".csv"))) {
          row_at_[row.pair_id] = rows_.size();
          rows_.push_back(std::move(row));
        }
      }
    } catch (const nlohmann::json::exception& error) {
      throw InputError(fmt::format("{}:{}: is damaged; remove the folder to begin again", path_, number));
    }
    begin = end + 1;
  }
}

const PairRow* PairJournal::Find(const std::string& pair_id) const {
  const auto found = row_at_.find(pair_id);
  return found == row_at_.end() ? nullptr : &rows_[found->second];
}

const DamagedImage* PairJournal::FindDamaged(const std::string& scene, const std::string& image) const {
  const auto found = std::ranges::find_if(
      damaged_, [&](const DamagedImage& d) { return d.scene == scene && d.image == image; });
  return found == damaged_.end() ? nullptr : &*found;
}

void PairJournal::AddLine(const std::string& line) {
  if (std::fwrite((line + "\n").data(), 1, line.size() + 1, file_) != line.size() + 1 ||
      std::fflush(file_) != 0)
    throw InputError(fmt::format("{}: cannot be written: {}", path_, std::strerror(errno)));
}

void PairJournal::Add(const PairRow& row) {
  AddLine(AsJson(row).dump());
  row_at_[row.pair_id] = rows_.size();
  rows_.push_back(row);
}

void PairJournal::Add(const DamagedImage& image) {
  AddLine(Json{{"damaged", image.image}, {"scene", image.scene}, {"message", image.message}}.dump());
  damaged_.push_back(image);
}

Table MakeIndexTable(const std::vector<PairRow>& rows) {
  using R = const PairRow&;
  const NumberFormat microseconds{1.0, "", ".6f", ".2g", ".6f"};
  return MakeTable<PairRow>(
      {{Column::Key("pair_id"), [](R r) { return r.pair_id; }},
       {Column::Count("t_gt_weak"), [](R r) { return std::int64_t{r.is_direction_weak}; }},
       {Column::Text("scene"), [](R r) { return r.scene; }},
       {Column::Count("kept"), [](R r) { return std::int64_t{r.reason == kKeptPair}; }},
       {Column::Text("reason"), [](R r) { return r.reason; }},
       {Column::Count("n_matches"), [](R r) { return r.num_matches; }},
       {Column::Count("n_inliers"),
        [](R r) { return r.num_inliers ? Value(std::int64_t{*r.num_inliers}) : Value(); }},
       {Column::Number("parallax_deg"), [](R r) { return r.parallax_deg; }},
       {Column::Number("true_rotation_deg"), [](R r) { return r.rotation_deg; }},
       {Column::Number("true_baseline"), [](R r) { return r.baseline; }},
       {Column::Number("time1_s", microseconds), [](R r) { return r.time1_s; }},
       {Column::Number("time2_s", microseconds), [](R r) { return r.time2_s; }},
       {Column::Text("image1"), [](R r) { return r.image1; }},
       {Column::Text("image2"), [](R r) { return r.image2; }}},
      rows);
}

std::string DescribeWhyNone(const std::vector<PairRow>& rows, const std::vector<DamagedImage>& damaged) {
  std::map<std::string, int> counts;
  for (const PairRow& row : rows) ++counts[row.reason];
  std::vector<std::string> reasons;
  for (const auto& [reason, count] : counts) reasons.push_back(fmt::format("{} {}", count, reason));
  std::string text =
      rows.empty() ? "no pair was kept: none could be made"
                   : fmt::format("no pair was kept: of {} pairs {}", rows.size(), fmt::join(reasons, ", "));
  if (!damaged.empty())
    text += fmt::format("; {} images were skipped, the first: {}", damaged.size(), damaged[0].message);
  return text;
}

std::string PairsAsTable(const std::vector<PairRow>& rows, const std::vector<DamagedImage>& damaged) {
  struct Counts {
    int looked_at = 0, with_truth = 0, damaged = 0;
    std::map<std::string, int> by_reason;
  };
  std::map<std::string, Counts> scenes;
  std::map<std::string, int> reasons;  // without "kept"
  for (const PairRow& row : rows) {
    Counts& counts = scenes[row.scene];
    ++counts.looked_at;
    ++counts.by_reason[row.reason];
    if (row.reason != kKeptPair) ++reasons[row.reason];
    if (row.reason == kKeptPair) counts.with_truth += !std::isnan(row.rotation_deg);
  }
  for (const DamagedImage& image : damaged) ++scenes[image.scene].damaged;
  std::vector<std::vector<std::string>> table = {{"scene", "pairs looked at", "kept", "with truth"}};
  for (const auto& [reason, count] : reasons) table[0].push_back(reason);
  table[0].emplace_back("skipped images");
  for (auto& [scene, counts] : scenes) {
    table.push_back({scene, fmt::format("{}", counts.looked_at),
                     fmt::format("{}", counts.by_reason[kKeptPair]), fmt::format("{}", counts.with_truth)});
    for (const auto& [reason, count] : reasons)
      table.back().push_back(fmt::format("{}", counts.by_reason[reason]));
    table.back().push_back(fmt::format("{}", counts.damaged));
  }
  std::string text = FormatColumns(table);
  for (const DamagedImage& image : damaged) text += fmt::format("skipped: {}\n", image.message);
  return text;
}

}  // namespace rcme
