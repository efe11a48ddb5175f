// A file of answers for `rcme import` that answers one problem.
#pragma once

#include <string>

namespace rcme {

// Refuses the first of the problems that `rcme export` wrote (problems.jsonl).
inline std::string RefusalOfFirst(const std::string& problems) {
  const std::string before = "\"id\":\"";
  const size_t first = problems.find(before) + before.size();
  return "{\"id\": \"" + problems.substr(first, problems.find('"', first) - first) +
         "\", \"status\": \"no_candidate\"}\n";
}

}  // namespace rcme
