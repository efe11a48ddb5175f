#include "experiments/data/truth_doubts.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "experiments/core/files/gzip_lines.h"
#include "experiments/core/text/field_text.h"
#include "parameters/input_error.h"

namespace rcme {

TruthDoubts::TruthDoubts(const std::string& path) : path_(path) {
  if (path.empty()) return;
  GzipLines lines(path, {"truth_in_doubt", "a CSV file with the columns scene and pair_id"});
  std::string_view line;
  const std::vector<std::string> names = lines.Next(&line) ? CsvFields(line) : std::vector<std::string>();
  const auto scene = static_cast<size_t>(std::ranges::find(names, "scene") - names.begin());
  const auto pair_id = static_cast<size_t>(std::ranges::find(names, "pair_id") - names.begin());
  if (std::max(scene, pair_id) >= names.size())
    lines.Fail("the columns scene and pair_id are needed, with their names in the first line");
  while (lines.Next(&line)) {
    if (line.empty()) continue;
    const std::vector<std::string> fields = CsvFields(line);
    if (std::max(scene, pair_id) >= fields.size())
      lines.Fail(fmt::format("{} columns; scene and pair_id are needed", fields.size()));
    pairs_.emplace(fields[scene], fields[pair_id]);
  }
}

bool TruthDoubts::Has(const std::string& scene, const std::string& pair_id) {
  const bool is_listed = pairs_.contains({scene, pair_id});
  is_any_found_ |= is_listed;
  return is_listed;
}

void TruthDoubts::RequireAnyFound(const std::string& folder) const {
  if (pairs_.empty() || is_any_found_) return;
  throw InputError(fmt::format(
      "truth_in_doubt: '{}' lists {} pairs, none of which is in '{}'; give a list with scenes and "
      "pair_ids (names of match files up to .csv) of this folder",
      path_, pairs_.size(), folder));
}

}  // namespace rcme
