#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/trial/trial_range.h"

namespace rcme {

// A set of places, as of trials in a condition or a shard.
class Places {
 public:
  static Places First(std::uint32_t num);

  // Returns false if the place was in the set already.
  bool Add(std::uint32_t place);
  void AddAll(const Places& other);
  bool Intersects(const Places& other) const;
  bool Has(std::uint32_t place) const { return place < has_.size() && has_[place]; }
  std::int64_t num() const { return num_; }
  // Returns the places of 0, ..., end - 1 that are not in the set, ascending.
  std::vector<TrialRange> Missing(std::uint32_t end) const;

  // Formats the set as "0-499,600".
  std::string Text() const;
  // Throws Damage.
  static Places FromText(const std::string& text);

 private:
  std::vector<bool> has_;
  std::int64_t num_ = 0;
};

}  // namespace rcme
