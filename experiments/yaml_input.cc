#include "experiments/yaml_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string_view>

namespace rcme {
namespace {

constexpr size_t kMaxBytes = size_t{1} << 20;

// How many bytes the UTF-8 character at the beginning of `text` has, which is not empty; 0: it is none.
size_t CharacterLength(std::string_view text) {
  const auto byte = [&](size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned lead = byte(0);
  if (lead < 0x80) return 1;
  if (lead < 0xC2 || lead > 0xF4) return 0;
  const size_t length = lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
  // The second byte excludes what has a shorter form, surrogates and what is beyond U+10FFFF (RFC 3629).
  const unsigned min = lead == 0xE0 ? 0xA0 : lead == 0xF0 ? 0x90 : 0x80;
  const unsigned max = lead == 0xED ? 0x9F : lead == 0xF4 ? 0x8F : 0xBF;
  if (byte(1) < min || byte(1) > max) return 0;
  for (size_t i = 2; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  return length;
}

void CheckIsUtf8(std::string_view text, const std::string& path) {
  for (int line = 1; !text.empty();) {
    const size_t length = CharacterLength(text);
    if (length == 0) {
      throw InputError(fmt::format("{}:{}: byte 0x{:02X} is not UTF-8; save the file as UTF-8", path, line,
                                   static_cast<unsigned char>(text.front())));
    }
    line += text.front() == '\n';
    text.remove_prefix(length);
  }
}

}  // namespace

void Place::Fail(const YAML::Node& node, const std::string& what) const {
  throw InputError(fmt::format("{}:{}: {}", path_, std::max(node.Mark().line, 0) + 1, what));
}

std::string Scalar(const Place& place, const YAML::Node& node, const std::string& key) {
  if (node.IsNull()) place.Fail(node, fmt::format("{}: the value is missing", key));
  if (!node.IsScalar()) place.Fail(node, fmt::format("{}: one value is needed, not a list or a map", key));
  return node.Scalar();
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
                 fmt::format("{}: unknown key '{}'; known keys: {}", name, key, fmt::join(known, ", ")));
    }
    if (!seen.insert(key).second)
      place.Fail(entry.first, fmt::format("{}: key '{}' stands twice", name, key));
    // The node of an empty value stands where the next token does, maybe lines below.
    if (entry.second.IsNull())
      place.Fail(entry.first, fmt::format("{}: the value of '{}' is missing", name, key));
    entries.emplace_back(key, entry.second);
  }
  return entries;
}

std::string ReadInputText(const std::string& path, const FileKind& kind) {
  if (path.empty())
    throw InputError(fmt::format("'' is not allowed; give the path of {}", kind.article_name));
  std::error_code none;  // what cannot be looked at cannot be opened either
  if (std::filesystem::is_directory(path, none))
    throw InputError(fmt::format("{}: is a folder, not {}", path, kind.article_name));
  std::ifstream file(path);
  if (!file) throw InputError(fmt::format("{}: no such {}, or not readable", path, kind.name));
  std::string text(kMaxBytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<size_t>(file.gcount()));
  return text;
}

YAML::Node ParseYaml(const std::string& yaml, const std::string& path, const FileKind& kind) {
  if (yaml.size() > kMaxBytes)
    throw InputError(fmt::format("{}: larger than {} can be (1 MiB)", path, kind.article_name));
  CheckIsUtf8(yaml, path);
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(yaml);
    if (documents.size() > 1)
      throw InputError(fmt::format("{}: holds more than one YAML document (---)", path));
    return documents.empty() ? YAML::Node() : documents[0];
  } catch (const YAML::Exception& error) {
    throw InputError(fmt::format("{}:{}: not valid YAML: {}", path, error.mark.line + 1, error.msg));
  }
}

}  // namespace rcme
