#include "estimator/solvers/upright_three_point.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "estimator/geometry/essential_matrix.h"
#include "estimator/geometry/pose.h"

namespace rcme {
namespace {

constexpr double kLeastRelativePart = 1e-9, kLeastDeterminant = 1e-12;

// A proper rotation whose second row is the direction of `gravity`, which it turns to (0, 1, 0).
Eigen::Matrix3d FindUprightRotation(const Eigen::Vector3d& gravity) {
  const Eigen::Vector3d y = gravity.normalized(), x = DirectionBasis(y).col(0);
  Eigen::Matrix3d A;
  A << x.transpose(), y.transpose(), x.cross(y).transpose();
  return A;
}

double CrossProduct(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// f_0 ... f_4 of the header.
using TrigonometricPolynomial = std::array<double, 5>;

TrigonometricPolynomial ComputeDeterminant(const UprightThreePoint::Rays& a,
                                           const UprightThreePoint::Rays& b) {
  std::array<Eigen::Vector2d, 3> w, h;
  for (size_t k = 0; k < 3; ++k) {
    w[k] = b[k].y() * Eigen::Vector2d(a[k].x(), -a[k].z());
    h[k] = a[k].y() * Eigen::Vector2d(-b[k].x(), b[k].z());
  }
  TrigonometricPolynomial f{};
  for (size_t k = 0; k < 3; ++k) {
    const size_t i = (k + 1) % 3, j = (k + 2) % 3;
    const double g = a[k].z() * b[k].x() - a[k].x() * b[k].z();
    const double l = -(a[k].x() * b[k].x() + a[k].z() * b[k].z());
    // v_i x v_j = constant + of_cos cos theta + of_sin sin theta
    const double constant = CrossProduct(w[i], w[j]) + CrossProduct(h[i], h[j]);
    const double of_cos = CrossProduct(w[i], h[j]) - CrossProduct(w[j], h[i]),
                 of_sin = w[j].dot(h[i]) - w[i].dot(h[j]);
    f[0] += 0.5 * (g * of_cos + l * of_sin);
    f[1] += g * constant;
    f[2] += l * constant;
    f[3] += 0.5 * (g * of_cos - l * of_sin);
    f[4] += 0.5 * (g * of_sin + l * of_cos);
  }
  return f;
}

struct Angle {
  double cos, sin;
};
constexpr Angle AddAngles(const Angle& a, const Angle& b) {
  return {a.cos * b.cos - a.sin * b.sin, a.sin * b.cos + a.cos * b.sin};
}

// 0 and four more angles, 72 deg from each other.
constexpr Angle kFifth = {0.30901699437494742410, 0.95105651629515357212};
constexpr std::array<Angle, 5> kStarts = {Angle{1.0, 0.0}, kFifth, AddAngles(kFifth, kFifth),
                                          AddAngles(kFifth, AddAngles(kFifth, kFifth)),
                                          Angle{kFifth.cos, -kFifth.sin}};

// f as a polynomial of theta - start.
TrigonometricPolynomial CountFrom(const Angle& start, const TrigonometricPolynomial& f) {
  const Angle twice = AddAngles(start, start);
  return {f[0], f[1] * start.cos + f[2] * start.sin, f[2] * start.cos - f[1] * start.sin,
          f[3] * twice.cos + f[4] * twice.sin, f[4] * twice.cos - f[3] * twice.sin};
}

// Coefficients of a polynomial of degree four or less, constant first.
using Quartic = std::array<double, 5>;

// (1 + q^2)^2 f, q = tan(theta / 2).
Quartic ConvertToQuartic(const TrigonometricPolynomial& f) {
  return {f[0] + f[1] + f[3], 2.0 * f[2] + 4.0 * f[4], 2.0 * f[0] - 6.0 * f[3], 2.0 * f[2] - 4.0 * f[4],
          f[0] - f[1] + f[3]};
}

Quartic Differentiate(const Quartic& p) { return {p[1], 2.0 * p[2], 3.0 * p[3], 4.0 * p[4], 0.0}; }

double Evaluate(const Quartic& p, double x) { return p[0] + x * (p[1] + x * (p[2] + x * (p[3] + x * p[4]))); }

// The root between `low` and `high`, where p has different signs: Newton's method, by bisection where a step
// would leave the bracket; the last step is shorter than `precision` times the root.
double FindRootBetween(const Quartic& p, const Quartic& derivative, double low, double high,
                       double precision) {
  constexpr int kMaxSteps = 80;
  const bool is_negative_at_low = Evaluate(p, low) < 0.0;
  double x = 0.5 * (low + high);
  for (int step = 0; step < kMaxSteps; ++step) {
    const double value = Evaluate(p, x);
    ((value < 0.0) == is_negative_at_low ? low : high) = x;
    double next = x - value / Evaluate(derivative, x);
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    const double length = std::abs(next - x);
    x = next;
    if (length <= precision * std::abs(x)) break;
  }
  return x;
}

struct RealRoots {
  std::array<double, 4> x;
  int count = 0;
};

// The real roots of a quartic, ascending. Between two neighbouring roots of its derivative, a polynomial is
// monotonic: the roots of the linear third derivative give those of the second, and so on. All are within
// 1 + max |p_i / p_4| of zero (Cauchy's bound; Gauss and Lucas for the derivatives). Roots of the derivatives
// need less precision, as they only separate.
RealRoots FindRealRoots(const Quartic& p) {
  std::array<Quartic, 5> derivatives = {p};
  for (size_t i = 1; i < 5; ++i) derivatives[i] = Differentiate(derivatives[i - 1]);
  double bound = 0.0;
  for (size_t i = 0; i < 4; ++i) bound = std::max(bound, std::abs(p[i] / p[4]));
  bound += 1.0;
  RealRoots roots;
  for (size_t order = 4; order-- > 0;) {
    const Quartic& now = derivatives[order];
    const double precision = order == 0 ? 2.0 * std::numeric_limits<double>::epsilon() : 1e-5;
    RealRoots next;
    for (int i = 0; i <= roots.count; ++i) {
      const double low = i == 0 ? -bound : roots.x[static_cast<size_t>(i - 1)];
      const double high = i == roots.count ? bound : roots.x[static_cast<size_t>(i)];
      if ((Evaluate(now, low) < 0.0) == (Evaluate(now, high) < 0.0)) continue;
      next.x[static_cast<size_t>(next.count++)] =
          FindRootBetween(now, derivatives[order + 1], low, high, precision);
    }
    roots = next;
  }
  return roots;
}

// The turned rays (unit vectors) of a sample.
UprightThreePoint::Rays TurnRays(const Eigen::Matrix3d& A, const UprightThreePoint::Rays& rays) {
  UprightThreePoint::Rays turned;
  for (size_t k = 0; k < 3; ++k) turned[k] = A * rays[k].normalized();
  return turned;
}

Eigen::Matrix3d RotationAboutY(const Angle& theta) {
  Eigen::Matrix3d R;
  R << theta.cos, 0.0, theta.sin, 0.0, 1.0, 0.0, -theta.sin, 0.0, theta.cos;
  return R;
}

// [s]x Ry, s of unit length perpendicular to n_1, n_2 and n_3: the longest cross product of two. False if
// they are parallel.
bool FindEssential(const Eigen::Matrix3d& Ry, const UprightThreePoint::Rays& a,
                   const UprightThreePoint::Rays& b, Eigen::Matrix3d* E) {
  std::array<Eigen::Vector3d, 3> n;
  for (size_t k = 0; k < 3; ++k) n[k] = (Ry * a[k]).cross(b[k]);
  Eigen::Vector3d s = Eigen::Vector3d::Zero();
  double longest = 0.0;
  for (size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d cross = n[k].cross(n[(k + 1) % 3]);
    longest = std::max(longest, n[k].squaredNorm());
    if (cross.squaredNorm() > s.squaredNorm()) s = cross;
  }
  const double length = s.norm();
  if (!(length > kLeastRelativePart * longest)) return false;
  *E = CrossMatrix(s / length) * Ry;
  return true;
}

}  // namespace

UprightThreePoint::UprightThreePoint(const Eigen::Vector3d& gravity1, const Eigen::Vector3d& gravity2)
    : upright1_(FindUprightRotation(gravity1)), upright2_(FindUprightRotation(gravity2)) {}

UprightThreePoint::Solutions UprightThreePoint::Solve(const Rays& rays1, const Rays& rays2) const {
  Solutions solutions;
  const Rays a = TurnRays(upright1_, rays1), b = TurnRays(upright2_, rays2);
  const TrigonometricPolynomial f = ComputeDeterminant(a, b);
  Angle start = kStarts[0];
  Quartic quartic{};
  for (const Angle& candidate : kStarts) {
    const Quartic other = ConvertToQuartic(CountFrom(candidate, f));
    if (!(std::abs(other[4]) > std::abs(quartic[4]))) continue;  // f at the opposite angle
    quartic = other;
    start = candidate;
  }
  if (!(std::abs(quartic[4]) > kLeastDeterminant) || !std::isfinite(quartic[4])) return solutions;

  const RealRoots roots = FindRealRoots(quartic);
  for (int i = 0; i < roots.count; ++i) {
    const double q = roots.x[static_cast<size_t>(i)], scale = 1.0 / (1.0 + q * q);
    const Eigen::Matrix3d Ry =
        RotationAboutY(AddAngles(start, Angle{(1.0 - q * q) * scale, 2.0 * q * scale}));
    Eigen::Matrix3d E;
    if (!FindEssential(Ry, a, b, &E)) continue;
    solutions.E[static_cast<size_t>(solutions.count++)] = upright2_.transpose() * E * upright1_;
  }
  return solutions;
}

}  // namespace rcme
