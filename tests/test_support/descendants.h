// Which processes are left of those that a test has had started: their command line or environment names a
// path that no other test has.
#pragma once

#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace rcme {

// Their command lines, this process left out.
inline std::vector<std::string> ProcessesNaming(const std::string& path) {
  namespace fs = std::filesystem;
  // Empty for a process that ends meanwhile: `<<` takes the failed read for the end of the text.
  const auto read = [](const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
  };
  std::vector<std::string> found;
  for (const fs::directory_entry& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos || name == std::to_string(getpid()))
      continue;
    const std::string command = read(entry.path() / "cmdline");
    if ((command + read(entry.path() / "environ")).find(path) != std::string::npos) found.push_back(command);
  }
  return found;
}

// Waits for their end, until `limit`; what is left then.
inline std::vector<std::string> ProcessesLeft(const std::string& path,
                                              std::chrono::milliseconds limit = std::chrono::seconds(2)) {
  const auto end = std::chrono::steady_clock::now() + limit;
  std::vector<std::string> left = ProcessesNaming(path);
  while (!left.empty() && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    left = ProcessesNaming(path);
  }
  return left;
}

}  // namespace rcme
