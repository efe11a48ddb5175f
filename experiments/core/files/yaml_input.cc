#include "experiments/core/files/yaml_input.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "parameters/plain_text.h"
#include "parameters/suggestion.h"

namespace rcme {
namespace {

constexpr size_t kMaxDepth = 20;
constexpr size_t kMaxValues = 20'000;
constexpr size_t kMaxScalarBytes = 10'000;
constexpr size_t kBytesOfOneValue = 64;  // a longer text counts as several values

// Counts depth and values while a document is parsed, so that it is refused before it is built. An alias
// (*a) counts with the values that it stands for, so a few lines cannot become many values.
class SizeCheck : public YAML::EventHandler {
 public:
  explicit SizeCheck(const Place& place) : place_(place) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (has_document_) place_.Fail(mark, "more than one YAML document (---) is not allowed");
    has_document_ = true;
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { AddValue(mark, anchor, 1); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto size = size_of_.find(anchor);
    if (size == size_of_.end()) place_.Fail(mark, "an alias (*) inside of what it stands for");
    Add(mark, size->second);
  }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                const std::string& value) override {
    if (value.size() > kMaxScalarBytes)
      place_.Fail(mark,
                  fmt::format("a value of {} bytes; at most {} are allowed", value.size(), kMaxScalarBytes));
    AddValue(mark, anchor, 1 + value.size() / kBytesOfOneValue);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    Open(mark, anchor);
  }
  void OnSequenceEnd() override { Close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    Open(mark, anchor);
  }
  void OnMapEnd() override { Close(); }

 private:
  struct Collection {
    YAML::anchor_t anchor = 0;  // 0: none
    size_t num_before = 0;
  };

  void Add(const YAML::Mark& mark, size_t num_values) {
    num_values_ += num_values;
    if (num_values_ > kMaxValues) {
      place_.Fail(mark, fmt::format("too many values; at most {} are allowed, an alias (*) counts as what it "
                                    "stands for",
                                    kMaxValues));
    }
  }
  void AddValue(const YAML::Mark& mark, YAML::anchor_t anchor, size_t num_values) {
    if (anchor) size_of_[anchor] = num_values;
    Add(mark, num_values);
  }
  void Open(const YAML::Mark& mark, YAML::anchor_t anchor) {
    open_.push_back({anchor, num_values_});
    if (open_.size() > kMaxDepth)
      place_.Fail(mark, fmt::format("lists and maps within each other deeper than {} levels are not allowed",
                                    kMaxDepth));
    Add(mark, 1);
  }
  void Close() {
    if (open_.back().anchor) size_of_[open_.back().anchor] = num_values_ - open_.back().num_before;
    open_.pop_back();
  }

  const Place& place_;
  bool has_document_ = false;
  size_t num_values_ = 0;
  std::vector<Collection> open_;
  std::map<YAML::anchor_t, size_t> size_of_;
};

// Throws InputError with file and line if `yaml` holds more than one document, lists and maps nested deeper
// than 20 levels, a text of more than 10,000 bytes, or more than 20,000 values. An alias (*a) counts as the
// values that it stands for. Nothing is built, so a few lines cannot fill memory. Throws YAML::Exception.
void CheckYamlSize(const std::string& yaml, const Place& place) {
  SizeCheck check(place);
  std::istringstream text(yaml);
  for (YAML::Parser parser(text); parser.HandleNextDocument(check);) {
  }
}

constexpr size_t kMaxBytes = size_t{1} << 20;
constexpr size_t kMaxNameBytes = 200;

void CheckIsUtf8(std::string_view text, const std::string& path) {
  for (int line = 1; !text.empty();) {
    const size_t length = Utf8Length(text);
    if (text.front() == '\0')
      throw InputError(fmt::format("{}:{}: byte 0x00 is no text; save the file as UTF-8", path, line));
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
