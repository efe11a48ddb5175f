// Reads YAML files that people write. Every error message names file, line and key.
#pragma once

#include <yaml-cpp/yaml.h>

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "experiments/core/files/regular_file.h"
#include "parameters/input_error.h"

namespace rcme {

// Where a message points to: "file:line: key".
class Place {
 public:
  explicit Place(std::string path) : path_(std::move(path)) {}
  const std::string& path() const { return path_; }
  // "file:line".
  std::string Text(const YAML::Mark& mark) const;
  std::string Text(const YAML::Node& node) const { return Text(node.Mark()); }
  [[noreturn]] void Fail(const YAML::Mark& mark, const std::string& what) const;
  [[noreturn]] void Fail(const YAML::Node& node, const std::string& what) const;
  // Runs `action`; an InputError from it gets file and line.
  template <typename Action>
  void At(const YAML::Node& node, Action action) const {
    try {
      action();
    } catch (const InputError& error) {
      Fail(node, error.what());
    }
  }

 private:
  std::string path_;
};

// The text of a node that is one value, without control characters.
std::string Scalar(const Place& place, const YAML::Node& node, const std::string& key);

// The same without tabs and line ends.
std::string Line(const Place& place, const YAML::Node& node, const std::string& key);

// A line of at most 200 bytes: tables, figures and pages show it.
std::string Name(const Place& place, const YAML::Node& node, const std::string& key);

// The entries of a map; unknown keys (if `known` is not empty) and repeated ones are errors.
std::vector<std::pair<std::string, YAML::Node>> Entries(const Place& place, const YAML::Node& map,
                                                        const std::string& name,
                                                        const std::set<std::string>& known);

// The bytes of a regular file, or one more than ParseYaml accepts. Throws InputError as RegularFile does.
std::string ReadInputText(const std::string& path, const FileKind& kind);

// The one document of a text of at most 1 MiB, 20 levels and 20,000 values; `path` is what the messages call
// it.
YAML::Node ParseYaml(const std::string& yaml, const std::string& path, const FileKind& kind);

}  // namespace rcme
