// Scores of models of different dimension for the relation between two images; the least score wins.
//
// A match is a point X = [x1; x2] of R^r, r = 4. A model with k parameters is a variety of dimension d in
// this space. A rotation and a homography determine x2 from x1 (d = 2), an epipolar geometry leaves the point
// on a line (d = 3). With normal noise sigma, e^2 is the squared distance of a match from the variety over
// sigma^2, chi-square with r - d degrees of freedom for a true match. A more general model always has a
// smaller sum of e^2, so every criterion adds a cost for generality:
//
//   aic         sum rho(e^2) + 2 k                                  (Akaike 1974: of the relation alone)
//   gic         sum rho(e^2) + 2 (d n + k)                          (Kanatani 1998, the geometric AIC)
//   gric        sum rho(e^2) + d n ln r + k ln(r n)                 (Torr 1998)
//   plunder_dl  d n_inlier + r n_outlier + k                        (Torr, Zisserman & Maybank 1998)
//
// with rho(e^2) = min(e^2, 2 (r - d)), Torr's bound for wrong matches. The term d n is the cost of the points
// on the variety, which are unknowns too; counting them as parameters in Akaike's criterion gives Kanatani's.
//
// Consequences for many matches. (A true match of the smaller model adds E rho = 1.73 if r - d = 2 and 0.74
// if r - d = 1; a wrong one adds the bound, 4 and 2.) All costs are per match, first for the homography and
// then for the epipolar geometry:
//
//   - aic never chooses a smaller model: a match on a plane costs 1.73 and 0.74.
//   - gic: on the plane 5.73 and 6.74, off it 8 and 6.74; wrong 8 and 8. A plane is recognised if it holds
//     more than 55 % of the true matches, however many matches are wrong. The bound of rho is the cost of a
//     match in the most general model, d = r, and hence equal for all models.
//   - gric: on the plane 4.50 and 4.90, off it 6.77 and 4.90; wrong 6.77 and 6.16. More than 82 % must be on
//     the plane if no match is wrong, and beyond 39 % of wrong matches no plane is recognised: the bound is
//     2 (r - d) and not (r - d) ln r.
//   - plunder_dl, inliers at 95 %: on the plane 2.1 and 3.05, off it 4 and 3.05: more than half.
//
// If only matches that agree with one of the models are used, wrong ones do not count, and gric keeps its 82
// %.
#pragma once

#include <span>

namespace rcme {

inline constexpr int kDimensionOfMatch = 4;  // r

struct ModelDimensions {
  int manifold = 0;    // d
  int parameters = 0;  // k
  int codimension() const { return kDimensionOfMatch - manifold; }
};
inline constexpr ModelDimensions kRotationDimensions{2, 3};
inline constexpr ModelDimensions kHomographyDimensions{2, 8};
inline constexpr ModelDimensions kEssentialDimensions{3, 5};

// Each takes e^2 of all matches, in units of sigma^2; e^2 is infinite if the model rules out the match.
double AicScore(std::span<const double> squared_residuals, const ModelDimensions& model);
double GicScore(std::span<const double> squared_residuals, const ModelDimensions& model);
double GricScore(std::span<const double> squared_residuals, const ModelDimensions& model);
// Inliers are the matches within the 95 % quantile of e^2.
double PlunderDlScore(std::span<const double> squared_residuals, const ModelDimensions& model);

}  // namespace rcme
