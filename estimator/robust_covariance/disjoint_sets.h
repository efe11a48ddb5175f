#pragma once

#include <numeric>
#include <vector>

namespace rcme {

// Union-find over the elements 0, 1, ...
class DisjointSets {
 public:
  explicit DisjointSets(size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), size_t{0}); }
  size_t Find(size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void Unite(size_t i, size_t k) { parent_[Find(i)] = Find(k); }
  // The number of each element's set: 0, 1, ... in the order of their first members.
  std::vector<int> Numbers() {
    std::vector<int> numbers, number_of(parent_.size(), -1);
    numbers.reserve(parent_.size());
    int num_sets = 0;
    for (size_t i = 0; i < parent_.size(); ++i) {
      int& number = number_of[Find(i)];
      if (number < 0) number = num_sets++;
      numbers.push_back(number);
    }
    return numbers;
  }

 private:
  std::vector<size_t> parent_;
};

}  // namespace rcme
