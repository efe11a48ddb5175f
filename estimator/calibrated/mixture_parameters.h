// The density of a match's residual under a motion: a mixture of right and wrong matches.
//
//   p(r, z) = w f(r / s) c(z / s) / s + (1 - w) q
//
//   r   signed Sampson residual g / |J|, in units of the assumed sigma
//   z   how far in front of both cameras the match lies, in standard deviations of its parallax; c lets
//       matches behind a camera be explained as noise as far as they are within it
//   f   Student's density with an odd number of degrees of freedom 2k - 1, C (1 + u^2 / (2k - 1))^-k
//   s   scale of the right matches' residuals, in units of the assumed sigma
//   w   share of right matches
//   q   density of a wrong match's residual near zero, per unit of the assumed sigma
//
// Where match i is said to be w_i times as noisy as the others (MotionProblem::noise_scale), its residual and
// its z have the noise w_i: a right match has r ~ w f(r / (w_i s)) c(z / (w_i s)) / (w_i s), a wrong one q as
// before, which does not depend on where key points are precise. In r' = r / w_i and z' = z / w_i, a density
// being multiplied by dr / dr' = w_i,
//
//   p(r', z') = w f(r' / s) c(z' / s) / s + (1 - w) q w_i
//
// so that everything goes on in r', z' and dr' / dp = (dr / dp) / w_i, with the density q w_i of a wrong
// match. The log-likelihood of r' exceeds that of r by sum log w_i, the same for every motion and mixture:
// modes are compared over the same matches. An error of the motion by x moves r' by x / w_i, which is how a
// precise match gets a weight of 1 / w_i^2 in the Hessian, and a leverage and an effective number
// accordingly.
#pragma once

namespace rcme {

// Student's law with 2 power - 1 degrees of freedom: five resist the tails of real key points at a loss of a
// tenth of the precision where the noise is Gaussian.
struct NoiseLaw {
  int power = 3;               // k
  double peak = 0.3796066898;  // C = Gamma(k) / (sqrt(pi (2k - 1)) Gamma(k - 1/2))
  // The scale that maximum likelihood finds in Gaussian noise of standard deviation 1: the root of
  // E[2k x^2 / ((2k - 1) s^2 + x^2)] = 1.
  double scale_of_gaussian = 0.8566;

  double dof() const { return 2.0 * power - 1.0; }
};
inline constexpr NoiseLaw kStudent15{8, 0.3923531628, 0.9419};  // fifteen: where there are hardly any tails

struct MixtureParameters {
  double scale = 1.0;             // s
  double inlier_ratio = 0.5;      // w
  double outlier_density = 1e-3;  // q
  NoiseLaw noise;
};

// z is flat beyond -1: c = 1 / (1 + min(z + 1, 0)^2)^2. A density of z that falls towards either side would
// pull the direction where the parallax is small.
inline double CheiralityFactor(double z) {
  const double beyond = z < -1.0 ? z + 1.0 : 0.0;
  const double d = 1.0 + beyond * beyond;
  return 1.0 / (d * d);
}

}  // namespace rcme
