#include "stats/point_set.h"

#include <boost/random/sobol.hpp>
#include <numeric>
#include <stdexcept>

#include "stats/random.h"

namespace rcme {
namespace {

using Points = std::vector<std::vector<double>>;

void FillWithSobol(std::span<const std::uint64_t> keys, std::uint64_t seed, std::uint32_t purpose,
                   Points* points) {
  std::vector<std::uint64_t> shifts;
  for (const std::uint64_t key : keys) shifts.push_back(RandomStream({seed, key, 0, purpose}).Next64());
  boost::random::sobol_engine<std::uint64_t, 64> engine(
      keys.size());  // leaves out the origin, its first point
  for (size_t i = 0; i < points->size(); ++i) {
    for (size_t d = 0; d < keys.size(); ++d) {
      const std::uint64_t bits = i == 0 ? 0 : engine();
      (*points)[i][d] = static_cast<double>((bits ^ shifts[d]) >> 11) * 0x1p-53;
    }
  }
}

void FillWithLatinHypercube(const StreamName& name, size_t axis, Points* points) {
  RandomStream rng(name);
  std::vector<std::uint32_t> places(points->size());
  std::iota(places.begin(), places.end(), 0U);
  rng.Shuffle(std::span(places));
  const double width = 1.0 / static_cast<double>(points->size());
  for (size_t i = 0; i < points->size(); ++i) (*points)[i][axis] = width * (places[i] + rng.Uniform());
}

}  // namespace

Points DrawPoints(PointSet kind, std::size_t num_points, std::span<const std::uint64_t> keys,
                  std::uint64_t seed, std::uint32_t purpose) {
  if (keys.size() > kMaxAxes) throw std::invalid_argument("points: too many axes");
  Points points(num_points, std::vector<double>(keys.size()));
  if (keys.empty()) return points;
  if (kind == PointSet::kSobol) {
    FillWithSobol(keys, seed, purpose, &points);
    return points;
  }
  for (size_t axis = 0; axis < keys.size(); ++axis) {
    if (kind == PointSet::kLatinHypercube) {
      FillWithLatinHypercube({seed, keys[axis], 0, purpose}, axis, &points);
      continue;
    }
    for (size_t i = 0; i < num_points; ++i) {
      RandomStream rng({seed, keys[axis], static_cast<std::uint32_t>(i), purpose});
      points[i][axis] = rng.Uniform();
    }
  }
  return points;
}

}  // namespace rcme
