// Which relation do two images obey? Scores of models that differ in dimension, so that the least wins.
//
// A match is a point X = [x1; x2] of R^r, r = 4. A model with k parameters is a variety of dimension d in it:
// a rotation and a homography fix x2 by x1 (d = 2), an epipolar geometry leaves the point on a line (d = 3).
// With normal noise sigma, e^2 is the squared distance of a match from the variety over sigma^2, chi-square
// with r - d degrees of freedom for a right match. The more a model leaves open, the smaller is its sum of
// e^2, whatever is true; every criterion below adds what it costs to leave things open:
//
//   aic         sum rho(e^2) + 2 k                                  (Akaike 1974: of the relation alone)
//   gic         sum rho(e^2) + 2 (d n + k)                          (Kanatani 1998, the geometric AIC)
//   gric        sum rho(e^2) + d n ln r + k ln(r n)                 (Torr 1998)
//   plunder_dl  d n_inlier + r n_outlier + k                        (Torr, Zisserman & Maybank 1998)
//
// with rho(e^2) = min(e^2, 2 (r - d)), Torr's bound for wrong matches. The d n is what the points on the
// variety cost, which are unknowns too; counting them as parameters in Akaike's criterion gives Kanatani's.
//
// What follows before any experiment (a right match of a smaller model adds E rho = 1.73 where r - d = 2 and
// 0.74 where r - d = 1; a wrong one adds the bound, 4 and 2):
//
//   - aic never chooses a smaller model of many matches: one on a plane costs the homography 1.73 and the
//     epipolar geometry 0.74.
//   - gic: on the plane 5.73 and 6.74, off it 8 and 6.74; wrong 8 and 8. A plane is seen where it holds
//     more than 55 % of the right matches, however many are wrong: rho's bound is what a match costs in the
//     model that leaves everything open, d = r, and so is the same for all models.
//   - gric: on the plane 4.50 and 4.90, off it 6.77 and 4.90; wrong 6.77 and 6.16. More than 82 % have to
//     be on the plane where none is wrong, and beyond 39 % of wrong matches no plane is seen any more: the
//     bound is 2 (r - d) and not (r - d) ln r.
//   - plunder_dl, inliers at 95 %: on the plane 2.1 and 3.05, off it 4 and 3.05: more than half.
//
// Of matches that agree with one of the models alone, wrong ones do not count, and gric keeps its 82 %.
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

// Each takes e^2 of all matches, in units of sigma^2; infinite where a model says that there is no such
// match.
double AicScore(std::span<const double> squared_residuals, const ModelDimensions& model);
double GicScore(std::span<const double> squared_residuals, const ModelDimensions& model);
double GricScore(std::span<const double> squared_residuals, const ModelDimensions& model);
// Inliers are the matches within the 95 % quantile of e^2.
double PlunderDlScore(std::span<const double> squared_residuals, const ModelDimensions& model);

}  // namespace rcme
