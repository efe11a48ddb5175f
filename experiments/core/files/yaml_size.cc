#include "experiments/core/files/yaml_size.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>

#include <map>
#include <sstream>
#include <vector>

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

}  // namespace

void CheckYamlSize(const std::string& yaml, const Place& place) {
  SizeCheck check(place);
  std::istringstream text(yaml);
  for (YAML::Parser parser(text); parser.HandleNextDocument(check);) {
  }
}

}  // namespace rcme
