#include "tests/benchmarks/processor.h"

#include <fstream>
#include <map>

namespace rcme {

std::string FindProcessor() {
  std::ifstream file("/proc/cpuinfo");
  std::map<std::string, std::string> first;  // value of each key where it comes first
  for (std::string line; std::getline(file, line) && !line.empty();) {
    const size_t colon = line.find(':');
    if (colon == std::string::npos || colon + 2 > line.size()) continue;
    first.emplace(line.substr(0, line.find_last_not_of(" \t", colon - 1) + 1), line.substr(colon + 2));
  }
  const std::string maker = first["vendor_id"], family = first["cpu family"], model = first["model"];
  return maker.empty() || family.empty() || model.empty() ? "unknown" : maker + " " + family + " " + model;
}

}  // namespace rcme
