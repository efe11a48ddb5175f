// Measures of how points spread over a region of the plane.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace rcme {

// Area of the convex hull; 0 for fewer than three points.
double ConvexHullArea(std::vector<Eigen::Vector2d> points);

// Mean distance between a point and its nearest neighbour; NaN for fewer than two points.
double MeanNearestNeighborDistance(std::vector<Eigen::Vector2d> points);

// Clark & Evans (1954): the mean nearest-neighbour distance in a rectangle over its expectation under
// complete randomness (with Donnelly's 1978 border correction). 1: random; below: clustered; above: regular,
// at most 2.15. NaN for fewer than two points.
double ClarkEvansIndex(const std::vector<Eigen::Vector2d>& points, double width, double height);

}  // namespace rcme
