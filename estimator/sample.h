#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <initializer_list>

namespace rcme {

class RandomStream;

inline constexpr int kMaxSampleSize = 8;  // the largest of all minimal solvers

// S_j (eq::minimal_sample_set): the distinct indices of the matches of a minimal sample. No heap allocation.
class Sample {
 public:
  constexpr Sample() = default;
  constexpr explicit Sample(int size) : size_(size) {}  // all zero, to be filled
  constexpr Sample(std::initializer_list<int> indices) : size_(static_cast<int>(indices.size())) {
    std::size_t k = 0;
    for (const int index : indices) indices_[k++] = index;
  }

  constexpr int size() const { return size_; }
  constexpr int& operator[](std::size_t k) { return indices_[k]; }
  constexpr int operator[](std::size_t k) const { return indices_[k]; }
  constexpr int* begin() { return indices_.data(); }
  constexpr int* end() { return indices_.data() + size_; }
  constexpr const int* begin() const { return indices_.data(); }
  constexpr const int* end() const { return indices_.data() + size_; }

  friend constexpr auto operator<=>(const Sample&, const Sample&) = default;

 private:
  std::array<int, kMaxSampleSize> indices_{};  // zero beyond size_
  int size_ = 0;
};

// `size` distinct indices below n, uniform over all sets; n >= size.
Sample DrawSample(int size, int n, RandomStream& rng);

// Identifies a hypothesis of a problem: its sample, and its number among the solver's models of that sample.
struct HypothesisId {
  Sample sample;
  int model = 0;  // 0, 1, ... in the solver's order

  friend constexpr auto operator<=>(const HypothesisId&, const HypothesisId&) = default;
};

}  // namespace rcme
