// The list of pairs whose given truth is in doubt, which `rcme check-truth` writes and anybody may: a CSV
// file with the columns scene and pair_id; others (a reason) are for people.
#pragma once

#include <set>
#include <string>
#include <utility>

namespace rcme {

class TruthDoubts {
 public:
  // Of the file, plain or gzip; an empty path is an empty list. Throws InputError: no such file, no such
  // columns, a line without them.
  explicit TruthDoubts(const std::string& path);

  // Whether the list has the pair, which is then found.
  bool Has(const std::string& scene, const std::string& pair_id);
  // Throws InputError where the list has pairs and `folder`, whose pairs were all asked for, none of them: it
  // is the list of others.
  void RequireAnyFound(const std::string& folder) const;

 private:
  std::string path_;
  std::set<std::pair<std::string, std::string>> pairs_;  // scene, pair_id
  bool is_any_found_ = false;
};

}  // namespace rcme
