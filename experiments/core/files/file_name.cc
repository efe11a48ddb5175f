#include "experiments/core/files/file_name.h"

#include <algorithm>
#include <cctype>

namespace rcme {

std::string MakeFileName(std::string name) {
  const auto is_odd = [](unsigned char c) {
    return std::isalnum(c) == 0 && c != '_' && c != '-' && c != '.';
  };
  std::ranges::replace_if(name, is_odd, '_');
  if (name.empty() || name.front() == '.') name.insert(0, "_");
  return name;
}

}  // namespace rcme
