#include "experiments/data/match_header.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>

#include "parameters/input_error.h"
#include "parameters/parameter.h"
#include "parameters/plain_text.h"
#include "parameters/suggestion.h"

namespace rcme {
namespace {

constexpr std::array<std::string_view, 24> kHeaderKeys = {"camera1",
                                                          "camera2",
                                                          "size1",
                                                          "size2",
                                                          "K1_fx_fy_cx_cy",
                                                          "K2_fx_fy_cx_cy",
                                                          "R_rowmajor",
                                                          "t_unit",
                                                          "truth_sd",
                                                          "baseline",
                                                          "noise_level",
                                                          "sigma_px",
                                                          "image1",
                                                          "image2",
                                                          "scene",
                                                          "seconds_between",
                                                          "prior_rotation_rowmajor",
                                                          "prior_rotation_sd_deg",
                                                          "gravity1",
                                                          "gravity2",
                                                          "gravity_sd_deg",
                                                          "prior_direction",
                                                          "prior_direction_sd_deg",
                                                          "better_score"};

}  // namespace

std::string_view Trim(std::string_view text) {
  const size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string> SplitAtCommas(std::string_view text) {
  std::vector<std::string> parts;
  while (true) {
    const size_t end = text.find(',');
    parts.emplace_back(Trim(text.substr(0, end)));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

std::vector<std::string> SplitAtBlanks(std::string_view text) {
  std::vector<std::string> parts;
  for (text = Trim(text); !text.empty(); text = Trim(text)) {
    const size_t end = std::min(text.find_first_of(" \t"), text.size());
    parts.emplace_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return parts;
}

void MatchHeader::AddLine(std::string_view line, const GzipLines& lines) {
  const size_t colon = line.find(':');
  if (colon == std::string_view::npos) return;  // a comment
  const std::string key(Trim(line.substr(1, colon - 1)));
  if (std::ranges::find(kHeaderKeys, key) == kHeaderKeys.end()) {
    const std::string meant = DidYouMean(key, {kHeaderKeys.begin(), kHeaderKeys.end()});
    if (!meant.empty())
      doubts_.push_back({fmt::format("{}:{}", path_, lines.line_number()),
                         fmt::format("{} is no key and is read as a comment{}", Quoted(key), meant)});
    return;
  }
  const Entry entry{std::string(Trim(line.substr(colon + 1))), lines.line_number()};
  if (!entries_.emplace(key, entry).second) lines.Fail(fmt::format("key '{}' stands twice", key));
}

std::string MatchHeader::Place(const std::string& key) const {
  return fmt::format("{}:{}: {}", path_, entries_.at(key).line_number, key);
}

std::vector<double> MatchHeader::Numbers(const std::string& key, size_t count) const {
  if (!Has(key)) {
    const bool is_of_camera = key.starts_with("size") || key.starts_with("K");
    const bool has_camera = Has("camera1") || Has("camera2");  // of the other image
    const bool has_a_part =
        has_camera || std::ranges::any_of(std::array{"size1", "size2", "K1_fx_fy_cx_cy", "K2_fx_fy_cx_cy"},
                                          [&](const char* other) { return Has(other); });
    const std::string missing =
        is_of_camera && has_camera ? fmt::format("camera{}", key.substr(key.find_first_of("12"), 1)) : key;
    throw InputError(fmt::format("{}: header key '# {}: ...' is missing{}", path_, missing,
                                 !is_of_camera ? ""
                                 : has_a_part
                                     ? "; add it, the header has others of the cameras"
                                     : " (without a header, give the intrinsics by `rcme estimate --K`)"));
  }
  std::vector<double> numbers;
  for (const std::string& word : SplitAtBlanks(entries_.at(key).text)) {
    double number = 0.0;
    if (!ParseReal(word, &number)) Fail(key, fmt::format("{} is not a finite number", Quoted(word)));
    numbers.push_back(number);
  }
  if (numbers.size() != count) Fail(key, fmt::format("has {} numbers; {} are needed", numbers.size(), count));
  return numbers;
}

Eigen::Matrix3d MatchHeader::Rotation(const std::string& key) const {
  const std::vector<double> r = Numbers(key, 9);
  Eigen::Matrix3d R;
  R << r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8];
  const double misfit = (R * R.transpose() - Eigen::Matrix3d::Identity()).norm();
  if (!(misfit < 1e-4) || R.determinant() < 0.0) Fail(key, "is not a rotation matrix");
  return R;
}

Eigen::Vector3d MatchHeader::Direction(const std::string& key) const {
  const std::vector<double> v = Numbers(key, 3);
  const Eigen::Vector3d direction(v[0], v[1], v[2]);
  const double length = direction.stableNorm();
  if (!(length > 1e-9) || !(length < 1e9)) Fail(key, "must have a length in (1e-9, 1e9)");
  return direction.normalized();
}

void MatchHeader::Fail(const std::string& key, const std::string& what) const {
  throw InputError(fmt::format("{}: {}", Place(key), what));
}

}  // namespace rcme
