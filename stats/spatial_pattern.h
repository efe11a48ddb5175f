// How points spread over a plane region.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace rcme {

// Area of the convex hull; 0 for fewer than three points.
double ConvexHullArea(std::vector<Eigen::Vector2d> points);

// Mean distance from a point to its nearest other point; NaN for fewer than two points.
double MeanNearestNeighborDistance(std::vector<Eigen::Vector2d> points);

// Clark & Evans (1954): the mean nearest-neighbour distance in a rectangle, over what complete randomness
// gives there (with Donnelly's 1978 correction for the border). 1: random; below: clustered; above:
// regular, 2.15 at most. NaN for fewer than two points.
double ClarkEvansIndex(const std::vector<Eigen::Vector2d>& points, double width, double height);

}  // namespace rcme
