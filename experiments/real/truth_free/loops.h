// Loops of images: ways along pairs that come back to where they began.
#pragma once

#include <vector>

#include "experiments/real/truth_free/pair_set.h"

namespace rcme {

inline constexpr size_t kLongestLoop = 6;  // images; the further the more errors add up

struct LoopStep {
  size_t pair = 0;
  bool is_forward = true;  // from image 1 to image 2
};
using Loop = std::vector<LoopStep>;  // from each image to the next, at least three

// A basis of the loops of at most `longest` images, as short as can be: every loop is the sum of some of
// them (a pair that two of them go along is not in it), and none is the sum of shorter ones, so that each
// says something new. Of two pairs of the same images the first counts.
//
// Candidates, by rising length: an image x, a pair (u, v), and the shortest ways from x to u and to v (of a
// breadth-first tree of each x), where these have but x in common. For every set S of pairs some shortest
// loop of an odd number of pairs in S is among them: let C be one and x on it. C is the sum over its pairs
// (u, v) of way(x, u) + (u, v) + way(x, v), since each way is there twice; an odd sum has an odd term, no
// longer than C. So the candidates hold a shortest basis, and to take each that is no sum of those taken
// finds it (Horton 1987; Mehlhorn and Michail 2009).
std::vector<Loop> FindLoops(const std::vector<NamedPair>& pairs, size_t longest = kLongestLoop);

// Loops of `length` images whose errors grow with it: forth from image to image in the order of their names,
// and back by one pair. From each image at most one, whose steps forth are the smallest. A video whose images
// are matched with the next w has them up to a length of w + 1.
std::vector<Loop> FindLoopsOfLength(const std::vector<NamedPair>& pairs, size_t length);

}  // namespace rcme
