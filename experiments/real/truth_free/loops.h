// Loops of images: cycles in the graph whose nodes are images and whose edges are pairs.
#pragma once

#include <vector>

#include "experiments/real/truth_free/pair_set.h"

namespace rcme {

inline constexpr size_t kLongestLoop = 6;  // images; errors accumulate with length

struct LoopStep {
  size_t pair = 0;
  bool is_forward = true;  // from image 1 to image 2
};
using Loop = std::vector<LoopStep>;  // steps from each image to the next, at least three

// A minimum cycle basis of the loops of at most `longest` images. Every loop is the sum modulo two of some
// basis loops (a pair in two of them cancels), and no basis loop is a sum of shorter ones, so that each is a
// new constraint. If several pairs join the same two images, the first counts.
//
// A candidate is an image x, a pair (u, v) and the shortest paths from x to u and to v (in a breadth-first
// tree of x), provided that these have only x in common. Candidates are tried by increasing length, and each
// that is not a sum of accepted ones is accepted. This finds a minimum basis (Horton 1987; Mehlhorn and
// Michail 2009), since for every set S of pairs some shortest loop with an odd number of pairs in S is a
// candidate: let C be such a loop and x on it. C is the sum over its pairs (u, v) of path(x, u) + (u, v) +
// path(x, v), as each path occurs twice; a sum that is odd in S has an odd term, and no term is longer than
// C.
std::vector<Loop> FindLoops(const std::vector<NamedPair>& pairs, size_t longest = kLongestLoop);

// Loops of `length` images whose errors grow with the length: they go forward through images in the order of
// their names and return by one pair. At most one loop starts at each image, the one with the smallest
// forward steps. A video whose images are each matched with the next w has such loops up to length w + 1.
std::vector<Loop> FindLoopsOfLength(const std::vector<NamedPair>& pairs, size_t length);

}  // namespace rcme
