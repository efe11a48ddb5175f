#include "experiments/real/truth_free/loops.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <utility>

namespace rcme {
namespace {

struct Way {
  size_t to = 0;
  LoopStep step;
};

// The graph of images, numbered in the order of their names, with the edges from each.
class Network {
 public:
  explicit Network(const std::vector<NamedPair>& pairs) {
    std::map<std::string, size_t> number_of;
    for (const NamedPair& pair : pairs) {
      if (IsNamed(pair)) number_of[pair.image1], number_of[pair.image2];
    }
    size_t next = 0;
    for (auto& [image, number] : number_of) number = next++;
    ways_.resize(next);
    std::set<std::pair<size_t, size_t>> seen;
    for (size_t i = 0; i < pairs.size(); ++i) {
      if (!IsNamed(pairs[i])) continue;
      const size_t a = number_of[pairs[i].image1], b = number_of[pairs[i].image2];
      if (!seen.insert(std::minmax(a, b)).second) continue;
      ways_[a].push_back({b, {i, true}});
      ways_[b].push_back({a, {i, false}});
    }
  }
  size_t num_images() const { return ways_.size(); }
  const std::vector<Way>& WaysFrom(size_t image) const { return ways_[image]; }

 private:
  static bool IsNamed(const NamedPair& pair) {
    return !pair.image1.empty() && !pair.image2.empty() && pair.image1 != pair.image2;
  }

  std::vector<std::vector<Way>> ways_;
};

// The shortest paths from one image, of at most `farthest` steps.
class Tree {
 public:
  Tree(const Network& network, size_t root, size_t farthest) {
    std::vector<size_t> at_distance = {root}, next;
    branches_[root] = {0, root, {}};
    for (size_t distance = 1; distance <= farthest; ++distance, at_distance = std::move(next), next.clear()) {
      for (const size_t from : at_distance) {
        for (const Way& way : network.WaysFrom(from)) {
          if (branches_.try_emplace(way.to, Branch{distance, from, way.step}).second) next.push_back(way.to);
        }
      }
    }
  }

  std::vector<size_t> Images() const {
    std::vector<size_t> images;
    for (const auto& [image, branch] : branches_) images.push_back(image);
    return images;
  }

  // The loop root -> u, the pair u -> v, v -> root if it has `length` steps and visits no image twice, else
  // an empty one. u must be in the tree.
  Loop LoopThrough(size_t u, const Way& to_v, size_t length) const {
    const auto at_v = branches_.find(to_v.to);
    if (at_v == branches_.end() || branches_.at(u).distance + at_v->second.distance + 1 != length) return {};
    std::set<size_t> on_first;
    Loop loop, back;
    for (size_t image = u; branches_.at(image).distance > 0; image = branches_.at(image).from) {
      on_first.insert(image);
      loop.push_back(branches_.at(image).step);
    }
    std::ranges::reverse(loop);
    loop.push_back(to_v.step);
    for (size_t image = to_v.to; branches_.at(image).distance > 0; image = branches_.at(image).from) {
      if (on_first.contains(image)) return {};
      const LoopStep there = branches_.at(image).step;
      loop.push_back({there.pair, !there.is_forward});
    }
    return loop;
  }

 private:
  struct Branch {
    size_t distance, from;
    LoopStep step;
  };
  std::map<size_t, Branch> branches_;
};

// Sums of loops, as sets of pairs, modulo two.
class Sums {
 public:
  // Returns false if the loop is the sum of loops added before.
  bool Add(const Loop& loop) {
    std::vector<size_t> rest;
    for (const LoopStep& step : loop) rest.push_back(step.pair);
    std::ranges::sort(rest);
    while (!rest.empty()) {
      const auto reduced_by = with_least_.find(rest.front());
      if (reduced_by == with_least_.end()) {
        const size_t least = rest.front();
        with_least_.emplace(least, std::move(rest));
        return true;
      }
      std::vector<size_t> sum;
      std::ranges::set_symmetric_difference(rest, reduced_by->second, std::back_inserter(sum));
      rest = std::move(sum);
    }
    return false;
  }

 private:
  std::map<size_t, std::vector<size_t>> with_least_;  // by the least pair in each
};

// Paths from an image to later ones that end where a pair leads back to it.
class WaysForth {
 public:
  WaysForth(const Network& network, size_t first) : network_(network) {
    for (const Way& way : network.WaysFrom(first)) {
      if (way.to > first) back_from_[way.to] = {way.step.pair, !way.step.is_forward};
    }
  }

  // `num_steps` steps forward from the image and one back to the first image; empty if there is no such path.
  Loop Find(size_t image, size_t num_steps) {
    if (num_steps == 0) {
      const auto back = back_from_.find(image);
      return back == back_from_.end() ? Loop() : Loop{back->second};
    }
    if (dead_ends_.contains({image, num_steps})) return {};
    std::map<size_t, LoopStep> later;  // by the image it leads to
    for (const Way& way : network_.WaysFrom(image)) {
      if (way.to > image) later[way.to] = way.step;
    }
    for (const auto& [to, step] : later) {
      Loop rest = Find(to, num_steps - 1);
      if (rest.empty()) continue;
      rest.insert(rest.begin(), step);
      return rest;
    }
    dead_ends_.insert({image, num_steps});
    return {};
  }

 private:
  const Network& network_;
  std::map<size_t, LoopStep> back_from_;
  std::set<std::pair<size_t, size_t>> dead_ends_;  // image, number of steps
};

}  // namespace

std::vector<Loop> FindLoopsOfLength(const std::vector<NamedPair>& pairs, size_t length) {
  const Network network(pairs);
  std::vector<Loop> loops;
  for (size_t first = 0; first < network.num_images(); ++first) {
    Loop loop = WaysForth(network, first).Find(first, length - 1);
    if (!loop.empty()) loops.push_back(std::move(loop));
  }
  return loops;
}

std::vector<Loop> FindLoops(const std::vector<NamedPair>& pairs, size_t longest) {
  const Network network(pairs);
  std::vector<Loop> loops;
  Sums sums;
  for (size_t length = 3; length <= longest; ++length) {
    for (size_t root = 0; root < network.num_images(); ++root) {
      const Tree tree(network, root, length / 2);
      for (const size_t u : tree.Images()) {
        for (const Way& way : network.WaysFrom(u)) {
          if (!way.step.is_forward) continue;
          Loop loop = tree.LoopThrough(u, way, length);
          if (!loop.empty() && sums.Add(loop)) loops.push_back(std::move(loop));
        }
      }
    }
  }
  return loops;
}

}  // namespace rcme
