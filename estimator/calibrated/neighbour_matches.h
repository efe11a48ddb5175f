// Matches that are neighbours in image 1, and whether they move alike.
#pragma once

#include <vector>

#include "estimator/motion_problem.h"

namespace rcme {

// The nearest neighbour in image 1 of each of the first 128 of `some`, as an index into `some`; its own index
// if it has none. Neighbours are at least `least_px` apart in both images.
std::vector<size_t> FindNearestNeighbours(const MotionProblem& problem, const std::vector<size_t>& some,
                                          double least_px);

// The share of these matches that move as their nearest neighbour at least one pixel away does: their
// displacements differ by no more than half the distance of the two plus three standard deviations. 0 without
// neighbours.
double ComputeCoherence(const MotionProblem& problem, const std::vector<size_t>& some);

}  // namespace rcme
