// The header of a match file (match_file.h): lines "# key: value" before and among the matches.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "estimator/geometry/pose.h"
#include "experiments/core/files/gzip_lines.h"
#include "experiments/data/input_doubt.h"

namespace rcme {

std::string_view Trim(std::string_view text);  // removes blanks at both ends
std::vector<std::string> SplitAtCommas(std::string_view text);
std::vector<std::string> SplitAtBlanks(std::string_view text);

// The values of known keys with their line numbers. Throws InputError with file, line, key and what is
// allowed for a value that cannot be read.
class MatchHeader {
 public:
  explicit MatchHeader(std::string path) : path_(std::move(path)) {}

  void AddLine(std::string_view line, const GzipLines& lines);

  std::string Place(const std::string& key) const;  // "file:12: key"
  // Comments that begin with nearly a key.
  const std::vector<InputDoubt>& doubts() const { return doubts_; }
  bool Has(const std::string& key) const { return entries_.count(key) > 0; }
  std::string Text(const std::string& key) const { return entries_.at(key).text; }

  // Throws InputError if the key is missing.
  std::vector<double> Numbers(const std::string& key, size_t count) const;
  Eigen::Matrix3d Rotation(const std::string& key) const;   // nine numbers, row by row
  Eigen::Vector3d Direction(const std::string& key) const;  // normalized; given with any length

  [[noreturn]] void Fail(const std::string& key, const std::string& what) const;

 private:
  struct Entry {
    std::string text;
    int line_number = 0;
  };
  std::string path_;
  std::map<std::string, Entry> entries_;
  std::vector<InputDoubt> doubts_;
};

}  // namespace rcme
