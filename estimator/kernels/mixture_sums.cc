#include "estimator/kernels/mixture_sums.h"

#include <algorithm>
#include <cmath>

#include "estimator/geometry/essential_matrix.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "estimator/kernels/mixture_sums.cc"
#include <hwy/foreach_target.h>
// The above must come before these.
#include "estimator/kernels/depth_in_noise-inl.h"
#include "estimator/kernels/epipolar-inl.h"
#include "stats/portable_math-inl.h"

#ifndef RCME_ESTIMATOR_KERNELS_MIXTURE_SUMS_ONCE_
#define RCME_ESTIMATOR_KERNELS_MIXTURE_SUMS_ONCE_
namespace rcme {

// A motion in the form of the kernels: F and its derivatives in whitened coordinates, the pose, the scale of
// rays.
struct MixtureModel {
  double F[9], dF[5][9];
  TwoViewPose pose;
  RayScale rays;
  double inverse_noise_rad;  // 1 / noise of the angle between two rays
};
// log_likelihood, num_right, sum_squares, num_wrong_near, then gradient and the Hessian's lower triangle.
inline constexpr int kNumScalars = 4, kNumMixtureSums = kNumScalars + 20;
enum class WantedSums { kAll, kLogLikelihood, kGradient };

}  // namespace rcme
#endif

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

// x^k, k >= 1.
HWY_INLINE Vec Power(Vec x, int k) {
  Vec power = x;
  for (int i = 1; i < k; ++i) power = power * x;
  return power;
}

// Squared gradient of g, which is the variance of g in whitened coordinates, bounded away from zero.
HWY_INLINE Vec SquaredGradient(const Constraint& c) {
  return Greater(Dot4(c.gradient, c.gradient), Set(1e-100));
}

// The noise scales of some matches. Without noise scales they are constants 1, which the compiler removes.
struct NoiseScales {
  Vec scale, inverse;
};
template <bool are_scaled>
HWY_INLINE NoiseScales LoadNoiseScales(const MatchBlocks& matches, int block, int lane) {
  if constexpr (!are_scaled) return {Set(1.0), Set(1.0)};
  const ScaleBlock& scales = matches.noise_scales()[static_cast<size_t>(block)];
  return {Load(scales.scale + lane), Load(scales.inverse + lane)};
}

// What the mixture's density at a match is computed from, in every lane of a vector. MixtureParameters states
// the model (s, w, q and the law of the noise); these are the inverses and products of its numbers. They are
// computed once: within the loop over the matches the compiler would divide again for every block.
struct MixtureConstants {
  Vec inverse_s2, inverse_noise;  // 1 / s^2; 1 / (s times the noise of the angle between two rays)
  Vec inverse_square;             // 1 / (s^2 dof), dof the degrees of freedom
  Vec inlier, outlier;            // w C / s and (1 - w) q
  Vec weight;                     // 2k / dof
  int power;                      // k
  HWY_INLINE MixtureConstants(const MixtureParameters& m, double inverse_noise_rad)
      : inverse_s2(Set(1.0 / (m.scale * m.scale))),
        inverse_noise(Set(inverse_noise_rad / m.scale)),
        inverse_square(Set(1.0 / m.noise.dof()) * inverse_s2),
        inlier(Set(m.inlier_ratio * m.noise.peak / m.scale)),
        outlier(Set((1.0 - m.inlier_ratio) * m.outlier_density)),
        weight(Set(2.0 * m.noise.power / m.noise.dof())),
        power(m.noise.power) {}
};

// The terms of the density at some matches, r = g / n. For a match with noise scale w, the caller passes n w
// for n, so that r is r'.
struct MixtureTerms {
  Vec inverse_n2, r2;                   // 1 / n^2, r^2
  Vec total, right, weight, curvature;  // density, p, v, p psi' - p (1 - p) psi^2 bounded from below
};
// Divisions and roots cost the most time. So c(z)^(-1/2) = 1 + min(z / s + 1, 0)^2 is a ratio of polynomials
// in the depth's `along` and sqrt(square), 1 + u^2 / dof one in g and n^2, and three inverses come from one.
HWY_INLINE MixtureTerms EvaluateMixture(Vec g, Vec n2, const DepthAngle& depth, const NoiseScales& noise,
                                        const MixtureConstants& m) {
  const Vec one = Set(1.0), g2 = g * g, inverse_noise = m.inverse_noise * noise.inverse;
  const Vec beyond = Lesser(FusedMulAdd(depth.along, inverse_noise, hn::Sqrt(depth.square)), Set(0.0));
  const Vec e = FusedMulAdd(beyond, beyond, depth.square);  // square c(z)^(-1/2)
  const Vec q = FusedMulAdd(g2, m.inverse_square, n2);      // n^2 (1 + u^2 / dof)
  const Vec qe = q * e, inverse_all = one / (n2 * qe);
  const Vec d = depth.square * (inverse_all * (n2 * q)), inverse_q = n2 * (inverse_all * (n2 * e));
  MixtureTerms terms;
  terms.inverse_n2 = inverse_all * qe;
  terms.r2 = g2 * terms.inverse_n2;
  const Vec inlier = m.inlier * Power(inverse_q, m.power) * (d * d);
  terms.total = inlier + m.outlier * noise.scale;
  terms.right = inlier / terms.total;
  terms.weight = m.weight * inverse_q;
  // psi' = v (2 / (1 + u^2 / dof) - 1), psi^2 = v^2 u^2
  const Vec bend = FusedMulSub(Set(2.0), inverse_q, one);
  const Vec doubt = (one - terms.right) * (terms.weight * (terms.r2 * m.inverse_s2));
  terms.curvature = terms.right * terms.weight * Greater(bend - doubt, Set(0.6));
  return terms;
}

// n dr / dp along the motion's five coordinates (kernels/sampson_equations.h), with u = g / n^2. For every
// derivative D of F, x2' D x1 - u (gradient of g)' (gradient of x2' D x1) = sum D_ij W_ij.
HWY_INLINE void EvaluateSlopes(const MixtureModel& model, const Matches& m, const Constraint& c, Vec u,
                               Vec* slopes) {
  const Vec x = FusedNegMulAdd(u, c.gradient[2], m.x2), y = FusedNegMulAdd(u, c.gradient[3], m.y2);
  const Vec du = u * c.gradient[0], dv = u * c.gradient[1];
  const Vec W[8] = {FusedMulSub(x, m.x1, m.x2 * du),
                    FusedMulSub(x, m.y1, m.x2 * dv),
                    x,
                    FusedMulSub(y, m.x1, m.y2 * du),
                    FusedMulSub(y, m.y1, m.y2 * dv),
                    y,
                    m.x1 - du,
                    m.y1 - dv};
  for (int k = 0; k < 5; ++k) {
    slopes[k] = Set(model.dF[k][8]);
    for (int i = 0; i < 8; ++i) slopes[k] = FusedMulAdd(Set(model.dF[k][i]), W[i], slopes[k]);
  }
}

// The scalar sums but the first one, the product of the densities.
HWY_INLINE void AddScalars(const MixtureTerms& terms, Vec right, Vec weight, Vec noise2, Mask is_used,
                           Vec* sums) {
  sums[1] = sums[1] + right;
  sums[2] = FusedMulAdd(weight, terms.r2, sums[2]);
  const Mask is_near = hn::And(is_used, terms.r2 * noise2 <= Set(kNearResidual * kNearResidual));
  sums[3] = sums[3] + hn::IfThenElseZero(is_near, Set(1.0) - terms.right);
}

HWY_INLINE void AddHessian(Vec curvature, const Vec* slopes, Vec* sums) {
  for (int row = 0, i = kNumScalars + 5; row < 5; ++row) {
    const Vec weighted = curvature * slopes[row];
    for (int col = 0; col <= row; ++col, ++i) sums[i] = FusedMulAdd(weighted, slopes[col], sums[i]);
  }
}

// Sums that are not wanted are zero; the others have the same bits whichever are wanted.
template <bool are_scaled, WantedSums wanted>
void SumMixtureOver(const MatchBlocks& matches, const MatchMask& mask, const MixtureModel& model,
                    const MixtureParameters& parameters, double* totals) {
  constexpr bool has_likelihood = wanted != WantedSums::kGradient;
  alignas(64) double partial[kNumMixtureSums][kBlockSize];
  const Vec one = Set(1.0), zero = Set(0.0);
  const MixtureConstants constants(parameters, model.inverse_noise_rad);
  for (int lane = 0; lane < kBlockSize; lane += kLanes) {
    Vec sums[kNumMixtureSums], product = one;
    for (Vec& sum : sums) sum = zero;
    for (int b = 0; b < matches.num_blocks(); ++b) {
      if (has_likelihood && b % 8 == 0) {
        sums[0] = sums[0] + ComputeLog(Tag(), product);
        product = one;
      }
      const unsigned bits = mask[static_cast<size_t>(b)];
      if (bits == 0) continue;
      const Mask is_used = MaskFromBits(bits >> lane);
      const Matches m = LoadMatches(matches[b], lane);
      const Constraint c = EvaluateConstraint(Broadcast{model.F}, m);
      const DepthAngle depth = Least(EvaluateDepths(model.pose, model.rays, m));
      const NoiseScales noise = LoadNoiseScales<are_scaled>(matches, b, lane);
      const Vec noise2 = noise.scale * noise.scale;
      const MixtureTerms terms = EvaluateMixture(c.g, SquaredGradient(c) * noise2, depth, noise, constants);
      if constexpr (has_likelihood) product = product * hn::IfThenElse(is_used, terms.total, one);
      if constexpr (wanted == WantedSums::kLogLikelihood) continue;
      const Vec u = c.g * terms.inverse_n2;
      Vec slopes[5];
      EvaluateSlopes(model, m, c, u * noise2, slopes);
      const Vec right = hn::IfThenElseZero(is_used, terms.right), weight = right * terms.weight;
      const Vec pull = weight * u * constants.inverse_s2;
      for (int k = 0; k < 5; ++k) {
        sums[kNumScalars + k] = FusedMulAdd(pull, slopes[k], sums[kNumScalars + k]);
      }
      if constexpr (wanted == WantedSums::kGradient) continue;
      AddScalars(terms, right, weight, noise2, is_used, sums);
      const Vec curvature = hn::IfThenElseZero(is_used, terms.curvature);
      AddHessian(curvature * terms.inverse_n2 * constants.inverse_s2, slopes, sums);
    }
    sums[0] = sums[0] + ComputeLog(Tag(), product);
    for (int i = 0; i < kNumMixtureSums; ++i) Store(sums[i], partial[i] + lane);
  }
  for (int i = 0; i < kNumMixtureSums; ++i) totals[i] = SumOfEight(partial[i]);
}

template <bool are_scaled>
void SumWanted(const MatchBlocks& matches, const MatchMask& mask, const MixtureModel& model,
               const MixtureParameters& parameters, WantedSums wanted, double* totals) {
  switch (wanted) {
    case WantedSums::kAll:
      return SumMixtureOver<are_scaled, WantedSums::kAll>(matches, mask, model, parameters, totals);
    case WantedSums::kLogLikelihood:
      return SumMixtureOver<are_scaled, WantedSums::kLogLikelihood>(matches, mask, model, parameters, totals);
    case WantedSums::kGradient:
      return SumMixtureOver<are_scaled, WantedSums::kGradient>(matches, mask, model, parameters, totals);
  }
}

void SumMixtureOverMatches(const MatchBlocks& matches, const MatchMask& mask, const MixtureModel& model,
                           const MixtureParameters& parameters, WantedSums wanted, double* totals) {
  if (matches.noise_scales().empty())
    return SumWanted<false>(matches, mask, model, parameters, wanted, totals);
  SumWanted<true>(matches, mask, model, parameters, wanted, totals);
}

// `lists`: residual, depth, five derivatives, without noise scales.
void ListTerms(const MatchBlocks& matches, int num_blocks, const MixtureModel& model, double* const* lists) {
  for (int b = 0; b < num_blocks; ++b) {
    for (int lane = 0; lane < kBlockSize; lane += kLanes) {
      const Matches m = LoadMatches(matches[b], lane);
      const Constraint c = EvaluateConstraint(Broadcast{model.F}, m);
      const Vec inverse_n = Set(1.0) / hn::Sqrt(SquaredGradient(c)), r = c.g * inverse_n;
      const Vec z =
          ComputeAngle(Least(EvaluateDepths(model.pose, model.rays, m))) * Set(model.inverse_noise_rad);
      Vec slopes[5];
      EvaluateSlopes(model, m, c, r * inverse_n, slopes);
      const int at = b * kBlockSize + lane;
      hn::StoreU(r, Tag(), lists[0] + at);
      hn::StoreU(z, Tag(), lists[1] + at);
      for (int k = 0; k < 5; ++k) hn::StoreU(slopes[k] * inverse_n, Tag(), lists[2 + k] + at);
    }
  }
}

template <bool are_scaled>
double SumCheiralityOver(const MatchBlocks& matches, int num_blocks, const MixtureModel& model,
                         double scale) {
  alignas(64) double partial[kBlockSize];
  const Vec one = Set(1.0), inverse_s2 = Set(1.0 / (scale * scale));
  for (int lane = 0; lane < kBlockSize; lane += kLanes) {
    Vec sum = Set(0.0);
    for (int b = 0; b < num_blocks; ++b) {
      const Matches m = LoadMatches(matches[b], lane);
      const Constraint c = EvaluateConstraint(Broadcast{model.F}, m);
      const NoiseScales noise = LoadNoiseScales<are_scaled>(matches, b, lane);
      const Vec n2 = Dot4(c.gradient, c.gradient) * (noise.scale * noise.scale);
      const Vec v = n2 / FusedMulAdd(c.g * c.g, inverse_s2, n2);
      const DepthAngles depths = EvaluateDepths(model.pose, model.rays, m);
      const Vec z = (ComputeAngle(depths.in1) + ComputeAngle(depths.in2)) *
                    (Set(0.5 * model.inverse_noise_rad) * noise.inverse);
      const Vec term = v * z / hn::Sqrt(FusedMulAdd(z, z, one));
      const Mask are_matches =
          hn::And(AreMatches(b * kBlockSize + lane, matches.num_matches()), term == term);
      sum = sum + hn::IfThenElseZero(are_matches, term);
    }
    Store(sum, partial + lane);
  }
  return SumOfEight(partial);
}

double SumCheiralityOverMatches(const MatchBlocks& matches, int num_blocks, const MixtureModel& model,
                                double scale) {
  if (matches.noise_scales().empty()) return SumCheiralityOver<false>(matches, num_blocks, model, scale);
  return SumCheiralityOver<true>(matches, num_blocks, model, scale);
}

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rcme {

HWY_EXPORT(SumMixtureOverMatches);
HWY_EXPORT(ListTerms);
HWY_EXPORT(SumCheiralityOverMatches);

namespace {

// 1 / noise of the angle between two rays: the noise of both, averaged over the scales of x and y.
double InverseNoise(const RayScale& s) {
  return 1.0 / std::sqrt(0.5 * (s.x1 * s.x1 + s.y1 * s.y1 + s.x2 * s.x2 + s.y2 * s.y2));
}

MixtureModel ModelAt(const MatchBlocks& matches, const RelativePose& pose, bool has_derivatives) {
  MixtureModel model{{}, {}, TwoViewPose(pose), matches.ray_scale(), InverseNoise(matches.ray_scale())};
  WriteRowMajor(matches.FundamentalFromEssential(EssentialFromPose(pose)), model.F);
  if (!has_derivatives) return model;
  const std::array<Eigen::Matrix3d, 5> dE = EssentialTangent(pose);
  for (size_t k = 0; k < 5; ++k) WriteRowMajor(matches.FundamentalFromEssential(dE[k]), model.dF[k]);
  return model;
}

}  // namespace

MixtureSums SumMixture(const MatchBlocks& matches, const MatchMask& mask, const RelativePose& pose,
                       const MixtureParameters& parameters) {
  double totals[kNumMixtureSums];
  HWY_DYNAMIC_DISPATCH(SumMixtureOverMatches)
  (matches, mask, ModelAt(matches, pose, true), parameters, WantedSums::kAll, totals);
  MixtureSums sums{totals[0], totals[1], totals[2], totals[3], Vector5d::Zero(), Matrix5d::Zero()};
  sums.gradient = Eigen::Map<const Vector5d>(totals + kNumScalars);
  for (int row = 0, i = kNumScalars + 5; row < 5; ++row) {
    for (int c = 0; c <= row; ++c, ++i) sums.hessian(row, c) = sums.hessian(c, row) = totals[i];
  }
  return sums;
}

Vector5d SumMixtureGradient(const MatchBlocks& matches, const MatchMask& mask, const RelativePose& pose,
                            const MixtureParameters& parameters) {
  double totals[kNumMixtureSums];
  HWY_DYNAMIC_DISPATCH(SumMixtureOverMatches)
  (matches, mask, ModelAt(matches, pose, true), parameters, WantedSums::kGradient, totals);
  return Eigen::Map<const Vector5d>(totals + kNumScalars);
}

double SumLogLikelihood(const MatchBlocks& matches, const MatchMask& mask, const RelativePose& pose,
                        const MixtureParameters& parameters) {
  double totals[kNumMixtureSums];
  HWY_DYNAMIC_DISPATCH(SumMixtureOverMatches)
  (matches, mask, ModelAt(matches, pose, false), parameters, WantedSums::kLogLikelihood, totals);
  return totals[0];
}

void EvaluateTerms(const MatchBlocks& matches, const RelativePose& pose, MatchTermLists* terms,
                   int most_matches) {
  const int num_blocks = (std::min(most_matches, matches.num_matches()) + kBlockSize - 1) / kBlockSize;
  const size_t size = static_cast<size_t>(num_blocks) * kBlockSize;
  double* lists[7];
  size_t k = 0;
  for (std::vector<double>* list :
       {&terms->residual, &terms->depth, &terms->derivative[0], &terms->derivative[1], &terms->derivative[2],
        &terms->derivative[3], &terms->derivative[4]}) {
    list->resize(size);
    lists[k++] = list->data();
  }
  HWY_DYNAMIC_DISPATCH(ListTerms)(matches, num_blocks, ModelAt(matches, pose, true), lists);
  if (matches.noise_scales().empty()) return;
  for (double* list : lists) {
    for (size_t i = 0; i < size; ++i) list[i] /= matches.NoiseScaleAt(i);
  }
}

double SumCheirality(const MatchBlocks& matches, int num_blocks, const RelativePose& pose, double scale) {
  return HWY_DYNAMIC_DISPATCH(SumCheiralityOverMatches)(matches, std::min(num_blocks, matches.num_blocks()),
                                                        ModelAt(matches, pose, false), scale);
}

}  // namespace rcme
#endif
