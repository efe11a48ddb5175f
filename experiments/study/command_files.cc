#include "experiments/study/command_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>

#include "experiments/study/command_permission.h"
#include "parameters/plain_text.h"
#include "parameters/text_lines.h"
#include "stats/fnv1a.h"

namespace rcme {
namespace {

constexpr std::string_view kLineBegin = "# file ";

// Words of the shell, and what follows an equals sign: `VAR=1 ./a --model=b.bin | "c d.py"` has five. What
// follows > is left out.
std::vector<std::string> SplitCommand(const std::string& command) {
  std::vector<std::string> words;
  std::string word;
  char quote = '\0';
  bool is_written = false;
  for (size_t i = 0; i <= command.size(); ++i) {
    const char c = i < command.size() ? command[i] : ' ';
    if (quote == '\0' && (c == '\'' || c == '"')) {
      quote = c;
    } else if (c == quote && quote != '\0') {
      quote = '\0';
    } else if (c == '\\' && quote != '\'' && i + 1 < command.size()) {
      word += command[++i];
    } else if (quote == '\0' && std::string_view(" \t\n|&;<>()=").find(c) != std::string_view::npos) {
      if (!word.empty() && !is_written) words.push_back(word);
      if (!word.empty()) is_written = false;
      is_written |= c == '>';
      word.clear();
    } else {
      word += c;
    }
  }
  return words;
}

}  // namespace

std::string HashFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  // In pieces, because a command may name a file of any size.
  std::array<char, 1 << 16> piece;
  Fnv1a hash;
  while (file) {
    file.read(piece.data(), std::ssize(piece));
    hash.Add({piece.data(), static_cast<size_t>(file.gcount())});
  }
  return fmt::format("{:016x}", hash.value());
}

std::vector<std::pair<std::string, std::string>> ListFilesOfCommand(const std::string& command) {
  std::vector<std::pair<std::string, std::string>> files;
  for (const std::string& word : SplitCommand(command)) {
    std::error_code ignored;
    if (std::filesystem::is_regular_file(word, ignored)) files.emplace_back(word, HashFile(word));
  }
  return files;
}

std::string HashFilesOfCommand(const std::string& command) {
  Fnv1a hash;
  for (const auto& [path, hash_of_file] : ListFilesOfCommand(command))
    hash.Add(path + " " + hash_of_file + "\n");
  return fmt::format("{:016x}", hash.value());
}

std::string IdentifyCommandFiles(const std::vector<EstimatorSpec>& estimators) {
  std::string text;
  for (const EstimatorSpec& spec : estimators) {
    for (const auto& [path, hash] : ListFilesOfCommand(FindCommand(spec)))
      text += fmt::format("{}{} of estimator {}: {}\n", kLineBegin, Printable(path), spec.label, hash);
  }
  return text;
}

bool IsOfCommandFile(const std::string& line) { return line.starts_with(kLineBegin); }

std::optional<std::string> FindChangedCommandFile(const std::string& there, const std::string& here) {
  std::array<std::vector<std::string>, 2> lines = {SplitText(there, '\n'), SplitText(here, '\n')}, of_files;
  for (size_t i = 0; i < lines.size(); ++i) {
    std::ranges::copy_if(lines[i], std::back_inserter(of_files[i]), IsOfCommandFile);
    std::erase_if(lines[i], IsOfCommandFile);
  }
  if (lines[0] != lines[1] || of_files[0] == of_files[1]) return std::nullopt;
  const auto [in_there, in_here] = std::ranges::mismatch(of_files[0], of_files[1]);
  const std::string line = in_here != of_files[1].end() ? *in_here : *in_there;
  return line.substr(std::string_view("# ").size(), line.rfind(": ") - std::string_view("# ").size());
}

}  // namespace rcme
