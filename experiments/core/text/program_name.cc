#include "experiments/core/text/program_name.h"

#include <algorithm>
#include <filesystem>

#include "parameters/plain_text.h"

namespace rcme {
namespace {

const std::string kRcme = "rcme " RCME_VERSION;

std::string& Name() {
  static std::string name = kRcme;
  return name;
}

}  // namespace

const std::string& ProgramName() { return Name(); }

std::string CommandName() {
  return Name() == kRcme ? "rcme" : Name().substr(0, Name().rfind(" (" + kRcme + ")"));
}

void NameProgram(const std::string& path) {
  std::string name = Printable(std::filesystem::path(path).filename().string(), 100);
  std::ranges::replace(name, ',', '_');  // result files list several programs with commas
  Name() = name.empty() || name == "rcme" ? kRcme : name + " (" + kRcme + ")";
}

}  // namespace rcme
