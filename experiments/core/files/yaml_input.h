// Reads YAML files written by people. Every error message names file, line and key.
#pragma once

#include <yaml-cpp/yaml.h>

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "experiments/core/files/regular_file.h"
#include "parameters/input_error.h"

namespace rcme {

// Creates messages that point to a place in a file: "file:line: key".
class Place {
 public:
  explicit Place(std::string path) : path_(std::move(path)) {}
  const std::string& path() const { return path_; }
  // For a text inside a value, which has no lines of its own: all its messages name the line of the value.
  Place FixLineTo(const YAML::Node& value) const;
  // "file:line".
  std::string Text(const YAML::Mark& mark) const;
  std::string Text(const YAML::Node& node) const { return Text(node.Mark()); }
  [[noreturn]] void Fail(const YAML::Mark& mark, const std::string& what) const;
  [[noreturn]] void Fail(const YAML::Node& node, const std::string& what) const;
  // Runs `action` and adds file and line to an InputError from it.
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
  std::optional<int> line_;  // of all messages, from 0; empty: each has its own
};

// Returns the text of a scalar node. Throws InputError if the node is no scalar or has control characters.
std::string Scalar(const Place& place, const YAML::Node& node, const std::string& key);

// Like Scalar, but tabs and line ends are errors, too.
std::string Line(const Place& place, const YAML::Node& node, const std::string& key);

// Like Line, but at most 200 bytes: tables, figures and pages show the name.
std::string Name(const Place& place, const YAML::Node& node, const std::string& key);

// Returns the entries of a map. Repeated keys are errors, and so are unknown keys unless `known` is empty.
std::vector<std::pair<std::string, YAML::Node>> Entries(const Place& place, const YAML::Node& map,
                                                        const std::string& name,
                                                        const std::set<std::string>& known);

// Reads a regular file, at most one byte more than ParseYaml accepts. Throws InputError as RegularFile does.
std::string ReadInputText(const std::string& path, const FileKind& kind);

// Parses a text of one YAML document: at most 1 MiB, 20 levels and 20,000 values. Messages call it `path`.
YAML::Node ParseYaml(const std::string& yaml, const std::string& path, const FileKind& kind);

}  // namespace rcme
