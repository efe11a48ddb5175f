// A list of pairs whose given truth is in doubt, written by `rcme check-truth` or by hand: a CSV file with
// the columns scene and pair_id; other columns (a reason) are for people.
#pragma once

#include <set>
#include <string>
#include <utility>

namespace rcme {

class TruthDoubts {
 public:
  // Reads the file, plain or gzip; an empty path gives an empty list. Throws InputError if the file does not
  // exist, lacks a column, or has a line without these fields.
  explicit TruthDoubts(const std::string& path);

  // Returns whether the pair is listed, and remembers that a listed pair was found.
  bool Has(const std::string& scene, const std::string& pair_id);
  // Throws InputError if the list has pairs but none of them was found in `folder`: then it is the list of
  // another folder. Call it after Has for all pairs of the folder.
  void RequireAnyFound(const std::string& folder) const;

 private:
  std::string path_;
  std::set<std::pair<std::string, std::string>> pairs_;  // scene, pair_id
  bool is_any_found_ = false;
};

}  // namespace rcme
