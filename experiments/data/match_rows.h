// The rows of a match file (match_file.h).
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/core/files/gzip_lines.h"
#include "experiments/data/match_file.h"

namespace rcme {

// Whether this text begins as a match file does, or as a compressed file: with a row of four numbers, or with
// column names, after its header.
bool IsMatchText(std::string_view text);

// The names of columns (match_file.h).
inline constexpr std::string_view kSigmaColumn = "sigma_px", kScoreColumn = "score";
inline constexpr std::array<std::string_view, 4> kCoordinateColumns = {"x1", "y1", "x2", "y2"};

// Reads the column names, which precede the first match, and the matches line by line. Throws InputError
// with file and line.
class MatchRows {
 public:
  explicit MatchRows(MatchFile* file) : file_(file) {}

  void Add(std::string_view line, const GzipLines& lines);

  std::string Place(size_t match) const;  // "file:12" of a match
  // Rows with more columns than stated are read by their first ones.
  std::vector<InputDoubt> ListDoubts() const;
  // Returns the scores; nothing unless there is exactly one such column. Call it only if the header has
  // better_score.
  std::optional<std::vector<double>> Scores() const;

 private:
  void SetNames(const std::vector<std::string>& fields, std::string_view line, const GzipLines& lines);
  double ReadSigma(const std::vector<std::string>& fields, const GzipLines& lines) const;

  MatchFile* file_;
  std::vector<int> line_numbers_;    // of the matches
  std::vector<std::string> scores_;  // of the matches, as text: only numbers if they are used
  bool has_names_ = false;
  size_t num_columns_ = kCoordinateColumns.size();
  std::optional<size_t> first_with_more_;       // match
  size_t sigma_column_ = 0, score_column_ = 0;  // 0, the place of x1: no such column
  std::ptrdiff_t num_score_columns_ = 0;
};

}  // namespace rcme
