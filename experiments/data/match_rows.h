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

// Names of columns (match_file.h).
inline constexpr std::string_view kSigmaColumn = "sigma_px", kScoreColumn = "score";
inline constexpr std::array<std::string_view, 4> kCoordinateColumns = {"x1", "y1", "x2", "y2"};

// The names of the columns, which stand before the first match, and the matches, as they come. What is wrong
// throws InputError with the file and the line.
class MatchRows {
 public:
  explicit MatchRows(MatchFile* file) : file_(file) {}

  void Add(std::string_view line, const GzipLines& lines);

  std::string Place(size_t match) const;  // "file:12" of a match
  // Of a file whose header says which scores are better; nothing without one such column.
  std::optional<std::vector<double>> Scores() const;

 private:
  void SetNames(const std::vector<std::string>& fields, std::string_view line, const GzipLines& lines);
  double ReadSigma(const std::vector<std::string>& fields, const GzipLines& lines) const;

  MatchFile* file_;
  std::vector<int> line_numbers_;    // of the matches
  std::vector<std::string> scores_;  // of the matches, as text: a number where the header names it a score
  size_t sigma_column_ = 0, score_column_ = 0;  // 0, where x1 is: none
  std::ptrdiff_t num_score_columns_ = 0;
};

}  // namespace rcme
