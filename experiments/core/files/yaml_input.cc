#include "experiments/core/files/yaml_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "experiments/core/files/yaml_size.h"
#include "parameters/plain_text.h"
#include "parameters/suggestion.h"

namespace rcme {
namespace {

constexpr size_t kMaxBytes = size_t{1} << 20;
constexpr size_t kMaxNameBytes = 200;

void CheckIsUtf8(std::string_view text, const std::string& path) {
  for (int line = 1; !text.empty();) {
    const size_t length = Utf8Length(text);
    if (length == 0) {
      throw InputError(fmt::format("{}:{}: byte 0x{:02X} is not UTF-8; save the file as UTF-8", path, line,
                                   static_cast<unsigned char>(text.front())));
    }
    line += text.front() == '\n';
    text.remove_prefix(length);
  }
}

}  // namespace

Place Place::FixLineTo(const YAML::Node& value) const {
  Place place(path_);
  place.line_ = value.Mark().line;
  return place;
}

std::string Place::Text(const YAML::Mark& mark) const {
  return fmt::format("{}:{}", path_, std::max(line_.value_or(mark.line), 0) + 1);
}

void Place::Fail(const YAML::Mark& mark, const std::string& what) const {
  throw InputError(fmt::format("{}: {}", Text(mark), what));
}

void Place::Fail(const YAML::Node& node, const std::string& what) const { Fail(node.Mark(), what); }

std::string Scalar(const Place& place, const YAML::Node& node, const std::string& key) {
  if (node.IsNull()) place.Fail(node, fmt::format("{}: the value is missing", key));
  if (!node.IsScalar()) place.Fail(node, fmt::format("{}: one value is needed, not a list or a map", key));
  if (FindNotPlain(node.Scalar()) != std::string::npos) {
    place.Fail(node, fmt::format("{}: {} is not allowed; give text without control characters", key,
                                 Quoted(node.Scalar())));
  }
  return node.Scalar();
}

std::string Line(const Place& place, const YAML::Node& node, const std::string& key) {
  const std::string line = Scalar(place, node, key);
  if (FindNotInLine(line) != std::string::npos) {
    place.Fail(node,
               fmt::format("{}: {} is not allowed; give one line of text without tabs", key, Quoted(line)));
  }
  return line;
}

std::string Name(const Place& place, const YAML::Node& node, const std::string& key) {
  const std::string name = Line(place, node, key);
  if (name.size() > kMaxNameBytes) {
    place.Fail(node, fmt::format("{}: {} is too long; at most {} bytes are allowed", key, Quoted(name),
                                 kMaxNameBytes));
  }
  return name;
}

std::vector<std::pair<std::string, YAML::Node>> Entries(const Place& place, const YAML::Node& map,
                                                        const std::string& name,
                                                        const std::set<std::string>& known) {
  if (!map.IsMap()) place.Fail(map, fmt::format("{}: a map of keys and values is needed", name));
  std::set<std::string> seen;
  std::vector<std::pair<std::string, YAML::Node>> entries;
  for (const auto& entry : map) {
    const std::string key = Scalar(place, entry.first, name);
    if (!known.empty() && known.count(key) == 0) {
      place.Fail(entry.first,
                 fmt::format("{}: unknown key {}{}; known keys: {}", name, Quoted(key),
                             DidYouMean(key, {known.begin(), known.end()}), fmt::join(known, ", ")));
    }
    if (!seen.insert(key).second)
      place.Fail(entry.first, fmt::format("{}: key {} stands twice", name, Quoted(key)));
    // yaml-cpp places an empty value at the next token, which may be lines below, so report the key's place.
    if (entry.second.IsNull())
      place.Fail(entry.first, fmt::format("{}: the value of {} is missing", name, Quoted(key)));
    entries.emplace_back(key, entry.second);
  }
  return entries;
}

std::string ReadInputText(const std::string& path, const FileKind& kind) {
  return RegularFile(path, kind).Read(kMaxBytes + 1);
}

YAML::Node ParseYaml(const std::string& yaml, const std::string& path, const FileKind& kind) {
  if (yaml.size() > kMaxBytes)
    throw InputError(fmt::format("{}: larger than {} can be (1 MiB)", path, kind.article_name));
  CheckIsUtf8(yaml, path);
  try {
    CheckYamlSize(yaml, Place(path));
    return YAML::Load(yaml);
  } catch (const YAML::Exception& error) {
    throw InputError(fmt::format("{}:{}: not valid YAML: {}", path, error.mark.line + 1, error.msg));
  }
}

}  // namespace rcme
