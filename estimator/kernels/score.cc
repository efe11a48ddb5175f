#include "estimator/kernels/score.h"

#include <algorithm>

#include "estimator/point_consistency.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "estimator/kernels/score.cc"
#include <hwy/foreach_target.h>
// The above must come before these.
#include "estimator/kernels/epipolar-inl.h"
#include "estimator/kernels/lanes-inl.h"
#include "estimator/kernels/printed_distance-inl.h"
#include "estimator/kernels/variance-inl.h"
#include "stats/portable_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

// The result of visit(matches) for a vector of matches: the inliers (eq::find-inlier) and their spreads. A visitor takes
// kSideBySide vectors.
struct Visited {
  Mask is_inlier;
  Vec spread;
};

// Scans one block: returns its inliers, and writes their spreads to *spread, which it advances. Overwrites
// what follows them, up to a block.
template <bool has_spread, typename Visit>
HWY_INLINE unsigned ScanBlock(const MatchBlock& block, int num_matches, const Visit& visit, double** spread) {
  unsigned bits = 0;
  for (int first = 0; first < kBlockSize; first += kSideBySide * kLanes) {
    Matches matches[kSideBySide];
    Visited visited[kSideBySide];
    for (int v = 0; v < kSideBySide; ++v) matches[v] = LoadMatches(block, first + v * kLanes);
    visit(matches, visited);
    for (int v = 0; v < kSideBySide; ++v) {
      const int lane = first + v * kLanes;
      const Mask is_inlier = num_matches < kBlockSize
                                 ? hn::And(visited[v].is_inlier, AreMatches(lane, num_matches))
                                 : visited[v].is_inlier;
      if constexpr (has_spread) {
        *spread += StoreSelected(visited[v].spread, is_inlier, *spread);
      }
      bits |= ReadMaskBits(is_inlier) << lane;
    }
  }
  return bits;
}

template <bool has_spread, typename Visit>
HWY_INLINE void Scan(const MatchBlock* blocks, int num_matches, InlierScan* scan, const Visit& visit) {
  double* spread = scan->spreads.data();
  std::uint8_t* inliers = scan->inliers.data();
  const int num_full = num_matches / kBlockSize, num_left = num_matches % kBlockSize;
  int num_inliers = 0;
  for (int b = 0; b < num_full; ++b) {
    const unsigned bits = ScanBlock<has_spread>(blocks[b], kBlockSize, visit, &spread);
    inliers[b] = static_cast<std::uint8_t>(bits);
    num_inliers += __builtin_popcount(bits);
  }
  if (num_left > 0) {
    const unsigned bits = ScanBlock<has_spread>(blocks[num_full], num_left, visit, &spread);
    inliers[num_full] = static_cast<std::uint8_t>(bits);
    num_inliers += __builtin_popcount(bits);
  }
  scan->num_inliers = num_inliers;
}

void ScanExact(const MatchBlock* blocks, int num_matches, const double* F, double threshold,
               InlierScan* scan) {
  const Vec limit = Set(threshold);
  Scan<false>(blocks, num_matches, scan, [&](const Matches* matches, Visited* visited) {
    for (int v = 0; v < kSideBySide; ++v) {
      const Constraint c = EvaluateConstraint(Broadcast{F}, matches[v]);
      visited[v] = {c.g * c.g <= limit * Dot4(c.gradient, c.gradient), limit};
    }
  });
}

struct OneModel {
  const WhitenedModel& model;
  HWY_INLINE Broadcast F() const { return {model.F}; }
  HWY_INLINE Broadcast dF(int k) const { return {model.dF[k]}; }
};

void ScanPrinted(const MatchBlock* blocks, int num_matches, const WhitenedModel& model, double threshold,
                 InlierScan* scan) {
  const Vec limit = Set(threshold);
  Scan<true>(blocks, num_matches, scan, [&](const Matches* matches, Visited* visited) {
    for (int v = 0; v < kSideBySide; ++v) {
      const PrintedDistance distance = EvaluatePrinted(OneModel{model}, matches[v]);
      visited[v] = {IsWithin(distance, limit), distance.determinant};
    }
  });
}

void ScanUncertain(const MatchBlock* blocks, int num_matches, const double* F, const double* coefficients,
                   double threshold, InlierScan* scan) {
  const Vec limit = Set(threshold);
  Scan<true>(blocks, num_matches, scan, [&](const Matches* matches, Visited* visited) {
    RankAwareTerms terms[kSideBySide];
    EvaluateRankAware<kSideBySide>(F, coefficients, matches, terms);
    for (int v = 0; v < kSideBySide; ++v) {
      const Vec total = terms[v].n2 + terms[v].variance;
      visited[v] = {terms[v].g2 <= limit * total, total / terms[v].n2};
    }
  });
}

// Number of vectors in a block.
constexpr int kVectors = kBlockSize / kLanes;

// The sum of `count` numbers. visit(first, values) writes the numbers of the block that starts at `first`;
// those beyond `count` are ignored.
template <typename Visit>
HWY_INLINE double SumOverBlocks(int count, const Visit& visit) {
  Vec sums[kVectors], values[kVectors];
  for (Vec& sum : sums) sum = Set(0.0);
  int first = 0;
  for (; first + kBlockSize <= count; first += kBlockSize) {
    visit(first, values);
    for (int v = 0; v < kVectors; ++v) sums[v] = sums[v] + values[v];
  }
  if (first < count) {
    visit(first, values);
    for (int v = 0; v < kVectors; ++v)
      sums[v] = sums[v] + hn::IfThenElseZero(AreMatches(first + v * kLanes, count), values[v]);
  }
  HWY_ALIGN double eight[kBlockSize];
  for (int v = 0; v < kVectors; ++v) Store(sums[v], eight + v * kLanes);
  return SumOfEight(eight);
}

constexpr int kMatchesAtOnce = 128;

// d2 and s2 / sigma^2 of up to kMatchesAtOnce matches, in whole blocks.
struct Predictions {
  HWY_ALIGN double d2[kMatchesAtOnce], s2[kMatchesAtOnce];

  HWY_INLINE void Fill(const MatchBlock* blocks, int num_matches, const double* F,
                       const double* coefficients) {
    const int num_whole = (num_matches + kBlockSize - 1) / kBlockSize * kBlockSize;
    for (int i = 0; i < num_whole && i < kMatchesAtOnce; i += kLanes) {
      const RankAwareTerms terms =
          EvaluateRankAware(F, coefficients, LoadMatches(blocks[i / kBlockSize], i % kBlockSize));
      const Vec total = terms.n2 + terms.variance;
      Store(terms.g2 / total, d2 + i);
      Store(total / terms.n2, s2 + i);
    }
  }
};

// Works in two steps. Polynomial and logarithm are long chains of operations; evaluated one after the other
// for each vector, they would fill the processor's window for out-of-order execution.
double SumNegativeLogLikelihood(const MatchBlock* blocks, int num_matches, const double* F,
                                const double* coefficients, double outlier_cost) {
  const Vec half = Set(0.5), log_two_pi = Set(1.8378770664093454836), limit = Set(outlier_cost);
  Predictions of;
  return SumOverBlocks(num_matches, [&](int first, Vec* costs) {
    if (first % kMatchesAtOnce == 0)
      of.Fill(blocks + first / kBlockSize, num_matches - first, F, coefficients);
    for (int v = 0; v < kVectors; ++v) {
      const int i = first % kMatchesAtOnce + v * kLanes;
      const Vec d2 = Load(of.d2 + i), log_s2 = ComputeLog(Tag(), Load(of.s2 + i));
      costs[v] = Lesser(half * (d2 + log_two_pi + log_s2), limit);  // also limit if a number is NaN
    }
  });
}

// The entropies of the inliers (eq::score-inliers, eq. 15), their mean and the sum of squares about it
// (eq. 16). Two passes, so that the sum loses no digits. Reads `spreads` beyond count, up to a block.
void SumEntropies(const double* spreads, int count, double offset, double* mean, double* sum_squares) {
  const Vec half = Set(0.5), shift = Set(offset);
  const auto entropy = [&](int i) {
    return FusedMulAdd(half, ComputeLog(Tag(), hn::LoadU(Tag(), spreads + i)), shift);
  };
  // Entropies of the first 512 inliers, so that their logarithms are taken only once.
  HWY_ALIGN double stored[512];
  const double sum = SumOverBlocks(count, [&](int first, Vec* values) {
    for (int v = 0; v < kVectors; ++v) {
      values[v] = entropy(first + v * kLanes);
      if (first < 512) Store(values[v], stored + first + v * kLanes);
    }
  });
  *mean = sum / count;
  const Vec center = Set(*mean);
  *sum_squares = SumOverBlocks(count, [&](int first, Vec* values) {
    for (int v = 0; v < kVectors; ++v) {
      const int i = first + v * kLanes;
      values[v] = Square((first < 512 ? Load(stored + i) : entropy(i)) - center);
    }
  });
}

// A hypothesis with its own model in each lane.
struct ModelPerLane {
  const HypothesisBlock& block;
  int lane;
  struct Rows {
    const HypothesisBlock::Row* rows;
    int lane;
    HWY_INLINE Vec operator()(int i) const { return Load(rows[i] + lane); }
  };
  HWY_INLINE Rows F() const { return {block.F, lane}; }
  HWY_INLINE Rows dF(int k) const { return {block.dF[k], lane}; }
};

// Whether every match of a sample agrees with its own motion (eq::sample-p-test, eq. 12).
unsigned TestSamples(const HypothesisBlock& block, double threshold) {
  const Vec limit = Set(threshold);
  unsigned bits = 0;
  for (int lane = 0; lane < kBlockSize; lane += kLanes) {
    Mask are_consistent = hn::FirstN(Tag(), kBlockSize);
    for (int k = 0; k < 8 && !hn::AllFalse(Tag(), are_consistent); ++k) {
      const Matches matches = {Load(block.x1[k] + lane), Load(block.y1[k] + lane), Load(block.x2[k] + lane),
                               Load(block.y2[k] + lane)};
      const PrintedDistance distance = EvaluatePrinted(ModelPerLane{block, lane}, matches);
      are_consistent = hn::And(are_consistent, IsWithin(distance, limit));
    }
    bits |= ReadMaskBits(are_consistent) << lane;
  }
  return bits;
}

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rcme {

HWY_EXPORT(ScanExact);
HWY_EXPORT(ScanPrinted);
HWY_EXPORT(ScanUncertain);
HWY_EXPORT(SumNegativeLogLikelihood);
HWY_EXPORT(SumEntropies);
HWY_EXPORT(TestSamples);

WhitenedModel::WhitenedModel(const HypothesisBlock& block, int hypothesis) {
  for (int i = 0; i < 9; ++i) {
    F[i] = block.F[i][hypothesis];
    for (int k = 0; k < 5; ++k) dF[k][i] = block.dF[k][i][hypothesis];
  }
}

std::optional<WhitenedModel> WhitenedModel::From(const MatchBlocks& matches, const RelativePose& pose,
                                                 const Matrix5d& pose_cov) {
  const std::optional<std::array<Eigen::Matrix3d, 5>> dE = WhitenedTangent(pose, pose_cov);
  if (!dE) return std::nullopt;
  WhitenedModel model;
  WriteRowMajor(matches.FundamentalFromEssential(EssentialFromPose(pose)), model.F);
  for (size_t k = 0; k < 5; ++k) WriteRowMajor(matches.FundamentalFromEssential((*dE)[k]), model.dF[k]);
  return model;
}

VariancePolynomial::VariancePolynomial(const double (&dF)[5][9]) : coefficients{} {
  constexpr int kFirst[] = {0, 0, 0, 1, 1, 2}, kSecond[] = {0, 1, 2, 1, 2, 2};  // the factors of a monomial
  for (int a = 0; a < 6; ++a) {
    for (int b = 0; b < 6; ++b) {
      const int i = 3 * kFirst[a], k = 3 * kSecond[a], j = kFirst[b], l = kSecond[b];
      double sum = 0.0;
      for (const double* D : dF) sum += D[i + j] * D[k + l] + D[i + l] * D[k + j];
      const bool is_square = i == k && j == l, is_product = i != k && j != l;
      coefficients[6 * a + b] = is_square ? 0.5 * sum : is_product ? 2.0 * sum : sum;
    }
  }
}

void ScanKnownPose(const MatchBlocks& matches, const double* F, double threshold, InlierScan* scan) {
  HWY_DYNAMIC_DISPATCH(ScanExact)(matches.data(), matches.num_matches(), F, threshold, scan);
}

void ScanAsPrinted(const MatchBlocks& matches, const WhitenedModel& model, double threshold,
                   InlierScan* scan) {
  HWY_DYNAMIC_DISPATCH(ScanPrinted)(matches.data(), matches.num_matches(), model, threshold, scan);
}

void ScanRankAware(const MatchBlocks& matches, const double* F, const VariancePolynomial& variance,
                   double threshold, InlierScan* scan) {
  HWY_DYNAMIC_DISPATCH(ScanUncertain)
  (matches.data(), matches.num_matches(), F, variance.coefficients, threshold, scan);
}

void RemoveSample(const Sample& sample, InlierScan* scan) {
  for (const int index : sample) {
    const auto byte = static_cast<size_t>(index / kBlockSize);
    const unsigned bit = 1u << (index % kBlockSize), before = scan->inliers[byte] & (bit - 1u);
    if ((scan->inliers[byte] & bit) == 0) continue;
    std::ptrdiff_t rank = __builtin_popcount(before);  // index among the inliers
    for (size_t b = 0; b < byte; ++b) rank += __builtin_popcount(scan->inliers[b]);
    const auto spreads = scan->spreads.begin();
    std::copy(spreads + rank + 1, spreads + scan->num_inliers, spreads + rank);
    scan->inliers[byte] = static_cast<std::uint8_t>(scan->inliers[byte] & ~bit);
    --scan->num_inliers;
  }
}

InlierScore SummarizeEntropies(const InlierScan& scan, double offset) {
  InlierScore score;
  score.num_inliers = scan.num_inliers;
  if (scan.num_inliers > 0) {
    HWY_DYNAMIC_DISPATCH(SumEntropies)
    (scan.spreads.data(), scan.num_inliers, offset, &score.mean_entropy, &score.sum_squares);
  }
  return score;
}

double NegativeLogLikelihood(const MatchBlocks& matches, const double* F, const VariancePolynomial& variance,
                             double outlier_cost) {
  return HWY_DYNAMIC_DISPATCH(SumNegativeLogLikelihood)(matches.data(), matches.num_matches(), F,
                                                        variance.coefficients, outlier_cost);
}

std::uint8_t FindConsistentSamples(const HypothesisBlock& block, double threshold) {
  return static_cast<std::uint8_t>(HWY_DYNAMIC_DISPATCH(TestSamples)(block, threshold));
}

}  // namespace rcme
#endif
