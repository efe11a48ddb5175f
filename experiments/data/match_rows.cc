#include "experiments/data/match_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "estimator/problem_check.h"
#include "experiments/data/match_header.h"
#include "parameters/input_error.h"
#include "parameters/parameter.h"
#include "parameters/plain_text.h"
#include "parameters/text_lines.h"

namespace rcme {
namespace {

constexpr size_t kMaxColumns = 1000;

bool AreColumnNames(const std::vector<std::string>& fields) {
  return std::ranges::find_first_of(fields, kCoordinateColumns) != fields.end();
}

// Whether these are words where coordinates should be, such as u1, v1, u2, v2. "nan" and "inf" are none.
bool AreWords(const std::vector<std::string>& fields) {
  return fields.size() >= kCoordinateColumns.size() &&
         std::ranges::none_of(fields.begin(), fields.begin() + kCoordinateColumns.size(),
                              [](const std::string& field) {
                                char* end = nullptr;
                                std::strtod(field.c_str(), &end);
                                return field.empty() || end != field.c_str();
                              });
}

std::vector<std::string> SplitRow(std::string_view line) {
  return line.find(',') == std::string_view::npos ? SplitAtBlanks(line) : SplitAtCommas(line);
}

bool HasColumnsFirst(const std::vector<std::string>& fields) {
  return fields.size() >= kCoordinateColumns.size() &&
         std::equal(kCoordinateColumns.begin(), kCoordinateColumns.end(), fields.begin());
}

Correspondence ReadMatch(const std::vector<std::string>& fields, const GzipLines& lines) {
  if (fields.size() < kCoordinateColumns.size())
    lines.Fail(
        fmt::format("{} columns; x1,y1,x2,y2 are needed, separated by commas or blanks", fields.size()));
  std::array<double, 4> x{};
  for (size_t i = 0; i < x.size(); ++i) {
    if (ParseReal(fields[i], &x[i]) && std::abs(x[i]) <= kMaxCoordinatePx) continue;
    lines.Fail(fmt::format("{}: {} is not a finite number in [{}, {}] px", kCoordinateColumns[i],
                           Quoted(fields[i]), -kMaxCoordinatePx, kMaxCoordinatePx));
  }
  return {{x[0], x[1]}, {x[2], x[3]}};
}

// Returns 0, the place of x1, if there is no such column.
size_t FindColumn(const std::vector<std::string>& fields, std::string_view name) {
  const auto found = std::ranges::find(fields, name);
  return found == fields.end() ? 0 : static_cast<size_t>(found - fields.begin());
}

}  // namespace

bool IsMatchText(std::string_view text) {
  constexpr std::string_view kGzip = "\x1f\x8b";
  if (text.starts_with(kGzip)) return true;
  constexpr size_t kMostBytes = 100'000;  // of a header
  for (const std::string& whole : SplitText(text.substr(0, kMostBytes), '\n')) {
    const std::string_view line = Trim(whole);
    if (line.empty() || line.front() == '#') continue;
    const std::vector<std::string> fields = SplitRow(line);
    double number = 0.0;
    const auto is_number = [&](const std::string& field) { return ParseReal(field, &number); };
    return HasColumnsFirst(fields) || (fields.size() >= kCoordinateColumns.size() &&
                                       std::all_of(fields.begin(), fields.begin() + 4, is_number));
  }
  return false;
}

void MatchRows::Add(std::string_view line, const GzipLines& lines) {
  const std::vector<std::string> fields = SplitRow(line);
  if (fields.size() > kMaxColumns)
    lines.Fail(fmt::format("too many columns; at most {} are allowed", kMaxColumns));
  const bool has_unknown_names = file_->matches.empty() && AreWords(fields);
  if (AreColumnNames(fields) || has_unknown_names) {
    SetNames(fields, line, lines);
  } else if (file_->matches.size() == kMaxMatchesPerFile) {
    lines.Fail(fmt::format("too many matches; at most {} are allowed", kMaxMatchesPerFile));
  } else {
    if (fields.size() > num_columns_ && !first_with_more_) first_with_more_ = file_->matches.size();
    file_->matches.push_back(ReadMatch(fields, lines));
    line_numbers_.push_back(lines.line_number());
    if (sigma_column_ > 0) file_->sigma_px.push_back(ReadSigma(fields, lines));
    if (score_column_ > 0) scores_.push_back(score_column_ < fields.size() ? fields[score_column_] : "");
  }
}

std::vector<InputDoubt> MatchRows::ListDoubts() const {
  if (!first_with_more_) return {};
  return {{Place(*first_with_more_),
           has_names_
               ? "a row has more columns than there are names; is it two rows?"
               : "columns without names: the first four are taken as x1,y1,x2,y2; a line of column names "
                 "says otherwise"}};
}

std::string MatchRows::Place(size_t match) const {
  return fmt::format("{}:{}", file_->path, line_numbers_.at(match));
}

// Throws InputError for a score that is not a finite number.
std::optional<std::vector<double>> MatchRows::Scores() const {
  if (num_score_columns_ != 1) return std::nullopt;
  std::vector<double> scores(scores_.size());
  for (size_t i = 0; i < scores.size(); ++i) {
    if (!ParseReal(scores_[i], &scores[i])) {
      throw InputError(
          fmt::format("{}: {}: {} is not a finite number", Place(i), kScoreColumn, Quoted(scores_[i])));
    }
  }
  return scores;
}

void MatchRows::SetNames(const std::vector<std::string>& fields, std::string_view line,
                         const GzipLines& lines) {
  if (!file_->matches.empty() || !HasColumnsFirst(fields)) {
    lines.Fail(
        fmt::format("column names {} are not allowed; give {}[,...], before the first match, or none; "
                    "further known columns: {}, {}",
                    Quoted(line), fmt::join(kCoordinateColumns, ","), kSigmaColumn, kScoreColumn));
  }
  for (const std::string_view name : {kCoordinateColumns[0], kCoordinateColumns[1], kCoordinateColumns[2],
                                      kCoordinateColumns[3], kSigmaColumn})
    if (std::ranges::count(fields, name) > 1) lines.Fail(fmt::format("column {} stands twice", name));
  has_names_ = true;
  num_columns_ = fields.size();
  sigma_column_ = FindColumn(fields, kSigmaColumn);
  score_column_ = FindColumn(fields, kScoreColumn);
  num_score_columns_ = std::ranges::count(fields, kScoreColumn);
}

double MatchRows::ReadSigma(const std::vector<std::string>& fields, const GzipLines& lines) const {
  double sigma_px = 0.0;
  const std::string text = sigma_column_ < fields.size() ? fields[sigma_column_] : "";
  if (!ParseReal(text, &sigma_px) || sigma_px <= 0.0 || sigma_px > kMaxCoordinatePx) {
    lines.Fail(fmt::format("{}: {} is not a finite number in (0, {}] px", kSigmaColumn, Quoted(text),
                           kMaxCoordinatePx));
  }
  return sigma_px;
}

}  // namespace rcme
