// The density of a match's residual under a motion: a mixture of inliers and outliers.
//
//   p(r, z) = w f(r / s) c(z / s) / s + (1 - w) q
//
//   r   signed Sampson residual g / |J|, in units of the assumed sigma
//   z   how far in front of both cameras the match lies, in standard deviations of its parallax
//   c   cheirality factor: a match behind a camera by no more than its noise may still be an inlier
//   f   Student's density with an odd number of degrees of freedom 2k - 1, C (1 + u^2 / (2k - 1))^-k
//   s   scale of the inliers' residuals, in units of the assumed sigma
//   w   share of inliers
//   q   density of an outlier's residual near zero, per unit of the assumed sigma
//
// Match i may be given as w_i times as noisy as the others (MotionProblem::noise_scale). Its residual and its
// z are then w_i times as noisy, too: an inlier has r ~ w f(r / (w_i s)) c(z / (w_i s)) / (w_i s). An outlier
// keeps the density q, which does not depend on the precision of key points. With r' = r / w_i and
// z' = z / w_i, and a factor dr / dr' = w_i for each density,
//
//   p(r', z') = w f(r' / s) c(z' / s) / s + (1 - w) q w_i
//
// so that all computations use r', z', dr' / dp = (dr / dp) / w_i and an outlier density q w_i. The
// log-likelihood of r' exceeds that of r by sum log w_i. This constant is the same for every motion and
// mixture, because modes are compared over the same matches. An error x of the motion moves r' by x / w_i. So
// a match has the weight 1 / w_i^2 in the Hessian, and leverage and effective number of matches follow.
#pragma once

namespace rcme {

// Student's law with 2 power - 1 degrees of freedom. Five degrees resist the tails of real key points, and
// lose a tenth of the precision if the noise is Gaussian.
struct NoiseLaw {
  int power = 3;               // k
  double peak = 0.3796066898;  // C = Gamma(k) / (sqrt(pi (2k - 1)) Gamma(k - 1/2))
  // The maximum-likelihood scale for Gaussian noise of standard deviation 1: the root of E[2k x^2 / ((2k - 1)
  // s^2 + x^2)] = 1.
  double scale_of_gaussian = 0.8566;

  double dof() const { return 2.0 * power - 1.0; }
};
// fifteen degrees, for noise with hardly any tails
inline constexpr NoiseLaw kStudent15{8, 0.3923531628, 0.9419};

struct MixtureParameters {
  double scale = 1.0;             // s
  double inlier_ratio = 0.5;      // w
  double outlier_density = 1e-3;  // q
  NoiseLaw noise;
};

// c = 1 / (1 + min(z + 1, 0)^2)^2, constant above z = -1. A density of z that falls to both sides would bias
// the direction at small parallax.
inline double CheiralityFactor(double z) {
  const double beyond = z < -1.0 ? z + 1.0 : 0.0;
  const double d = 1.0 + beyond * beyond;
  return 1.0 / (d * d);
}

}  // namespace rcme
