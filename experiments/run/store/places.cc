#include "experiments/run/store/places.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/core/files/damage.h"
#include "parameters/parameter.h"
#include "parameters/text_lines.h"

namespace rcme {
namespace {

std::uint32_t PlaceIn(const std::string& text) {
  long long place = 0;
  if (!ParseInteger(text, &place) || place < 0 || place > 2'000'000'000)
    throw Damage(fmt::format("'{}' of table counted is not possible", text));
  return static_cast<std::uint32_t>(place);
}

}  // namespace

bool Places::Add(std::uint32_t place) {
  if (place >= has_.size()) has_.resize(std::max<size_t>(place + size_t{1}, 2 * has_.size()));
  if (has_[place]) return false;
  has_[place] = true;
  ++num_;
  return true;
}

Places Places::First(std::uint32_t num) {
  Places places;
  places.has_.assign(num, true);
  places.num_ = num;
  return places;
}

void Places::AddAll(const Places& other) {
  for (std::uint32_t place = 0; place < other.has_.size(); ++place) {
    if (other.has_[place]) Add(place);
  }
}

bool Places::Intersects(const Places& other) const {
  for (std::uint32_t place = 0; place < std::min(has_.size(), other.has_.size()); ++place) {
    if (has_[place] && other.has_[place]) return true;
  }
  return false;
}

std::vector<TrialRange> Places::Missing(std::uint32_t end) const {
  std::vector<TrialRange> missing;
  for (std::uint32_t place = 0; place < end; ++place) {
    if (Has(place)) continue;
    if (missing.empty() || missing.back().end != place) missing.push_back({place, place});
    missing.back().end = place + 1;
  }
  return missing;
}

std::string Places::Text() const {
  std::string text;
  for (size_t first = 0; first < has_.size(); ++first) {
    if (!has_[first]) continue;
    size_t last = first;
    while (last + 1 < has_.size() && has_[last + 1]) ++last;
    text += fmt::format("{}{}", text.empty() ? "" : ",", first);
    if (last > first) text += fmt::format("-{}", last);
    first = last;
  }
  return text;
}

Places Places::FromText(const std::string& text) {
  Places places;
  for (const std::string& range : SplitText(text, ',')) {
    const size_t dash = range.find('-');
    const std::uint32_t first = PlaceIn(range.substr(0, dash));
    const std::uint32_t last = dash == std::string::npos ? first : PlaceIn(range.substr(dash + 1));
    if (last < first || first < places.has_.size())
      throw Damage(fmt::format("'{}' of table counted is not possible", range));
    places.has_.resize(first);
    places.has_.resize(last + size_t{1}, true);
    places.num_ += last - first + 1;
  }
  return places;
}

}  // namespace rcme
