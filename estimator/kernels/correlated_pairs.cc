#include "estimator/kernels/correlated_pairs.h"

#include <algorithm>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "estimator/kernels/correlated_pairs.cc"
#include <hwy/foreach_target.h>
// The above must come before these.
#include "estimator/kernels/lanes-inl.h"
#include "estimator/kernels/lookup-inl.h"

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

constexpr int kLengths = kNumCorrelationLengths;
// Correlations are computed for eight points with up to this many blocks of others at a time, so that they
// are used while they are in the L1 cache (12 kB).
constexpr int kTileBlocks = 8;
struct alignas(64) Tile {
  double c[kTileBlocks][kBlockSize][kLengths][kBlockSize];  // [block of h][g][length][h]
};
// Sums for the eight points g of a tile, by lane of h.
struct alignas(64) RowSums {
  double lanes[kBlockSize][kLengths][5][kBlockSize] = {};
};

// 2^(-d / 8) for d >= 0; d is limited to 8000. With d = k + s, k an integer and |s| <= 1/2: 2^(-k / 8) is a
// power of two times one of eight numbers. 2^(-s / 8) = e^(-s h) with h = ln(2) / 8 is a polynomial whose
// next term is below 6e-14.
HWY_INLINE Vec ComputeDecay(Vec d) {
  alignas(64) static constexpr double kPowers[] = {1.0,
                                                   0x1.172b83c7d517bp+0,  // 2^(1 / 8), 2^(2 / 8), ...
                                                   0x1.306fe0a31b715p+0,
                                                   0x1.4bfdad5362a27p+0,
                                                   0x1.6a09e667f3bcdp+0,
                                                   0x1.8ace5422aa0dbp+0,
                                                   0x1.ae89f995ad3adp+0,
                                                   0x1.d5818dcfba487p+0};
  constexpr double h = kDistanceUnit, h2 = h * h, h3 = h * h2;
  static constexpr double kTaylor[] = {
      1.0, -h, h2 / 2.0, -h3 / 6.0, h * h3 / 24.0, -h2 * h3 / 120, h3 * h3 / 720.0};
  const Lookup::IndexTag integers;
  d = Lesser(d, Set(8000.0));
  // 1.5 2^52 - d is rounded to an integer with -k in its low bits.
  const Vec big = Set(0x1.8p52), rounded = big - d, s = d + (rounded - big);
  Vec sum = Set(kTaylor[6]);
  for (int j = 6; j-- > 0;) sum = FusedMulAdd(sum, s, Set(kTaylor[j]));
  // -k = 8 e + i: e is added to the exponent of 2^(i / 8).
  const auto bits = hn::BitCast(integers, rounded), seven = hn::Set(integers, std::int64_t{7});
  const Vec power = Lookup(hn::And(bits, seven))(kPowers);
  return sum * hn::BitCast(Tag(), hn::BitCast(integers, power) + hn::ShiftLeft<49>(hn::AndNot(seven, bits)));
}

HWY_INLINE Vec ComputeLength(Vec x, Vec y) { return hn::Sqrt(FusedMulAdd(x, x, y * y)); }

// Computes c of the points g of a block with the points h of blocks `first` to `last` - 1, in lanes `lane`
// and following; zero for h >= g.
HWY_INLINE void FillTile(const CorrelatedBlock* points, int rows, int first, int last, int lane, Tile* tile) {
  const CorrelatedBlock& block = points[rows];
  for (int g = 0; g < kBlockSize; ++g) {
    Vec at[4], normal[4];
    for (int i = 0; i < 4; ++i) {
      at[i] = Set(block.at[i][g]);
      normal[i] = Set(block.normal[i][g]);
    }
    for (int b = first; b < last; ++b) {
      Vec offset[4], other[4];
      for (int i = 0; i < 4; ++i) {
        offset[i] = at[i] - Load(points[b].at[i] + lane);
        other[i] = Load(points[b].normal[i] + lane);
      }
      Vec cos1 = FusedMulAdd(normal[0], other[0], normal[1] * other[1]);
      Vec cos2 = FusedMulAdd(normal[2], other[2], normal[3] * other[3]);
      if (b == rows) {
        const Mask is_before = hn::FirstN(Tag(), static_cast<size_t>(std::max(g - lane, 0)));
        cos1 = hn::IfThenElseZero(is_before, cos1);
        cos2 = hn::IfThenElseZero(is_before, cos2);
      }
      const Vec e1 = ComputeDecay(ComputeLength(offset[0], offset[1]));
      const Vec e2 = ComputeDecay(ComputeLength(offset[2], offset[3]));
      // cos e, cos e^3, cos e^9
      const Vec squared1 = e1 * e1, squared2 = e2 * e2;
      const Vec long1 = cos1 * e1, long2 = cos2 * e2;
      const Vec middle1 = long1 * squared1, middle2 = long2 * squared2;
      const Vec sixth1 = squared1 * squared1 * squared1, sixth2 = squared2 * squared2 * squared2;
      double(&c)[kLengths][kBlockSize] = tile->c[b - first][g];
      Store(FusedMulAdd(middle1, sixth1, middle2 * sixth2), c[0] + lane);
      Store(middle1 + middle2, c[1] + lane);
      Store(long1 + long2, c[2] + lane);
    }
  }
}

// The sums over all pairs that do not belong to one point.
struct alignas(64) WholeSums {
  double squares[6][kBlockSize] = {}, excess[6][kBlockSize] = {}, products[kLengths][kBlockSize] = {};
};

// Adds c_k c_m over the pairs of a tile; with `is_excess`, times (product of both weights - 1).
template <bool is_excess>
HWY_INLINE void AddSquares(const CorrelatedBlock* points, const Tile& tile, int rows, int first, int last,
                           int lane, double (&sums)[6][kBlockSize]) {
  Vec totals[6];
  for (int i = 0; i < 6; ++i) totals[i] = Load(sums[i] + lane);
  for (int g = 0; g < kBlockSize; ++g) {
    const Vec weight_g = Set(points[rows].weight[g]);
    for (int b = first; b < last; ++b) {
      const double(&c)[kLengths][kBlockSize] = tile.c[b - first][g];
      const Vec of_pair[kLengths] = {Load(c[0] + lane), Load(c[1] + lane), Load(c[2] + lane)};
      Vec excess;
      if constexpr (is_excess) excess = FusedMulSub(weight_g, Load(points[b].weight + lane), Set(1.0));
      for (int k = 0, i = 0; k < kLengths; ++k) {
        Vec c_k = of_pair[k];
        if constexpr (is_excess) c_k = c_k * excess;
        for (int m = 0; m <= k; ++m, ++i) totals[i] = FusedMulAdd(c_k, of_pair[m], totals[i]);
      }
    }
  }
  for (int i = 0; i < 6; ++i) Store(totals[i], sums[i] + lane);
}

HWY_INLINE void AddProducts(const CorrelatedBlock* points, const Tile& tile, int rows, int first, int last,
                            int lane, double (&sums)[kLengths][kBlockSize]) {
  for (int k = 0; k < kLengths; ++k) {
    Vec total = Load(sums[k] + lane);
    for (int g = 0; g < kBlockSize; ++g) {
      Vec of_g = Set(0.0);
      for (int b = first; b < last; ++b)
        of_g = FusedMulAdd(Load(tile.c[b - first][g][k] + lane), Load(points[b].residual + lane), of_g);
      total = FusedMulAdd(Set(points[rows].residual[g]), of_g, total);
    }
    Store(total, sums[k] + lane);
  }
}

// Adds c_gh x_g to each h (AddToOthers) and c_gh x_h to each g (AddToRows), where x are five numbers of a
// point.
HWY_INLINE void AddToOthers(const double (&x)[5][kBlockSize], const Tile& tile, int b, int lane,
                            double (&smoothed)[kLengths][5][kBlockSize]) {
  for (int k = 0; k < kLengths; ++k) {
    Vec sums[5];
    for (int j = 0; j < 5; ++j) sums[j] = Load(smoothed[k][j] + lane);
    for (int g = 0; g < kBlockSize; ++g) {
      const Vec c = Load(tile.c[b][g][k] + lane);
      for (int j = 0; j < 5; ++j) sums[j] = FusedMulAdd(c, Set(x[j][g]), sums[j]);
    }
    for (int j = 0; j < 5; ++j) Store(sums[j], smoothed[k][j] + lane);
  }
}
template <double (CorrelatedBlock::*x)[5][kBlockSize]>
HWY_INLINE void AddToRows(const CorrelatedBlock* others, const Tile& tile, int num_blocks, int lane,
                          RowSums* row_sums) {
  for (int g = 0; g < kBlockSize; ++g) {
    double(&of_g)[kLengths][5][kBlockSize] = row_sums->lanes[g];
    Vec sums[kLengths][5];
    for (int k = 0; k < kLengths; ++k) {
      for (int j = 0; j < 5; ++j) sums[k][j] = Load(of_g[k][j] + lane);
    }
    for (int b = 0; b < num_blocks; ++b) {
      for (int k = 0; k < kLengths; ++k) {
        const Vec c = Load(tile.c[b][g][k] + lane);
        for (int j = 0; j < 5; ++j) sums[k][j] = FusedMulAdd(c, Load((others[b].*x)[j] + lane), sums[k][j]);
      }
    }
    for (int k = 0; k < kLengths; ++k) {
      for (int j = 0; j < 5; ++j) Store(sums[k][j], of_g[k][j] + lane);
    }
  }
}

HWY_INLINE void AddRowSums(const RowSums& row_sums, double (&smoothed)[kLengths][5][kBlockSize]) {
  for (int g = 0; g < kBlockSize; ++g) {
    for (int k = 0; k < kLengths; ++k) {
      for (int j = 0; j < 5; ++j) smoothed[k][j][g] += SumOfEight(row_sums.lanes[g][k][j]);
    }
  }
}

// Points in blocks from `num_repeated` on have one match each and no excess.
void SumPairs(const CorrelatedBlock* points, int num_blocks, int num_repeated, CorrelatedPairSums* sums) {
  WholeSums whole;
  Tile tile;
  RowSums of_rows, of_excess;
  for (int rows = 0; rows < num_blocks; ++rows) {
    of_rows = {};
    if (num_repeated > 0) of_excess = {};
    for (int first = 0; first <= rows; first += kTileBlocks) {
      const int last = std::min(first + kTileBlocks, rows + 1), last_repeated = std::min(last, num_repeated);
      for (int lane = 0; lane < kBlockSize; lane += kLanes) {
        FillTile(points, rows, first, last, lane, &tile);
        AddSquares<false>(points, tile, rows, first, last, lane, whole.squares);
        AddProducts(points, tile, rows, first, last, lane, whole.products);
        AddToRows<&CorrelatedBlock::row>(points + first, tile, last - first, lane, &of_rows);
        for (int b = first; b < last; ++b)
          AddToOthers(points[rows].row, tile, b - first, lane, sums->smoothed[static_cast<size_t>(b)].row);
        if (first < last_repeated) {
          AddSquares<true>(points, tile, rows, first, last_repeated, lane, whole.excess);
          AddToRows<&CorrelatedBlock::excess>(points + first, tile, last_repeated - first, lane, &of_excess);
        }
        if (rows >= num_repeated) continue;
        for (int b = first; b < last; ++b)
          AddToOthers(points[rows].excess, tile, b - first, lane,
                      sums->smoothed[static_cast<size_t>(b)].mean);
      }
    }
    SmoothedBlock& smoothed = sums->smoothed[static_cast<size_t>(rows)];
    AddRowSums(of_rows, smoothed.row);
    if (num_repeated > 0) AddRowSums(of_excess, smoothed.mean);
  }
  for (int i = 0; i < 6; ++i) {
    sums->squares[i] = SumOfEight(whole.squares[i]);
    sums->weighted[i] = sums->squares[i] + SumOfEight(whole.excess[i]);
  }
  for (int k = 0; k < kLengths; ++k) sums->products[k] = SumOfEight(whole.products[k]);
}

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rcme {

HWY_EXPORT(SumPairs);

CorrelatedPairSums SumCorrelatedPairs(const std::vector<CorrelatedBlock>& points, size_t num_repeated) {
  CorrelatedPairSums sums;
  sums.smoothed.resize(points.size());
  HWY_DYNAMIC_DISPATCH(SumPairs)
  (points.data(), static_cast<int>(points.size()),
   static_cast<int>((num_repeated + kBlockSize - 1) / kBlockSize), &sums);
  for (SmoothedBlock& smoothed : sums.smoothed) {
    double *mean = &smoothed.mean[0][0][0], *row = &smoothed.row[0][0][0];  // so far, mean holds the excess
    for (int i = 0; i < kNumCorrelationLengths * 5 * kBlockSize; ++i) mean[i] += row[i];
  }
  return sums;
}

}  // namespace rcme
#endif
