#include "experiments/real/truth_free/closure_by_length.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "experiments/real/truth_free/loops.h"
#include "stats/distributions.h"
#include "stats/shared_members.h"

namespace rcme {
namespace {

constexpr int kRotationFreedom = 3;  // of a rotation

// The squared closure error of each loop, normalised, of the pairs and of their twins. Twins of different
// numbers share no error.
struct LoopDistances {
  std::vector<GroupValue> of_pairs, of_twins;
};

LoopDistances ComputeLoopDistances(const std::vector<PairAnswers>& answers, const std::vector<Loop>& loops,
                                   SharedErrors shared) {
  const std::vector<ImageNumbers> images = NumberImages(answers);
  const auto most_images = static_cast<std::int64_t>(2 * answers.size() + 1);
  LoopDistances distances;
  for (const Loop& loop : loops) {
    std::vector<std::int64_t> members;
    for (const LoopStep& step : loop) {
      members.push_back(images[step.pair].image1);
      members.push_back(images[step.pair].image2);
    }
    for (const UnitValues& values : ComputeClosures(answers, {loop}, RotationClosure, shared)) {
      for (const double value : values.observed) distances.of_pairs.push_back({members, value});
      std::vector<std::int64_t> of_twin = members;
      for (const double value : values.null) {
        for (std::int64_t& member : of_twin) member += most_images;
        distances.of_twins.push_back({of_twin, value});
      }
    }
  }
  return distances;
}

LengthClosure SummarizeLength(std::vector<GroupValue> distances) {
  const SharedGroupMean mean = MeasureSharedGroupMean(distances);
  const double bound = ChiSquareQuantile(kRotationFreedom, 0.95);
  for (GroupValue& distance : distances) distance.value = distance.value <= bound ? 1.0 : 0.0;
  const SharedGroupMean rate = MeasureSharedGroupRate(distances);
  const auto root = [](double x) { return std::sqrt(std::max(x, 0.0) / kRotationFreedom); };
  LengthClosure closure;
  closure.num_loops = mean.n;
  closure.num_apart = mean.num_apart;
  closure.covered = {rate.value, rate.interval};
  closure.rms_over_sd = {root(mean.value), {root(mean.interval.lower), root(mean.interval.upper)}};
  return closure;
}

std::vector<NamedPair> ListNames(const std::vector<PairAnswers>& answers) {
  std::vector<NamedPair> names;
  for (const PairAnswers& answer : answers) {
    const NamedPair& pair = answer.whole.pair;
    const bool is_ok = answer.whole.IsOk();
    names.push_back({pair.name, is_ok ? pair.image1 : "", is_ok ? pair.image2 : "", {}});
  }
  return names;
}

}  // namespace

std::vector<LengthClosure> MeasureClosureByLength(const std::vector<PairAnswers>& answers, size_t longest) {
  const std::vector<NamedPair> names = ListNames(answers);
  std::vector<LengthClosure> closures;
  for (size_t length = 3; length <= longest; ++length) {
    const std::vector<Loop> loops = FindLoopsOfLength(names, length);
    for (const SharedErrors shared : {SharedErrors::kAllowedFor, SharedErrors::kIgnored}) {
      LoopDistances distances = ComputeLoopDistances(answers, loops, shared);
      for (const bool is_of_twins : {false, true}) {
        std::vector<GroupValue>& of = is_of_twins ? distances.of_twins : distances.of_pairs;
        if (of.empty()) continue;
        LengthClosure closure = SummarizeLength(std::move(of));
        closure.num_images = length;
        closure.is_of_twins = is_of_twins;
        closure.shared = shared;
        closures.push_back(closure);
      }
    }
  }
  return closures;
}

}  // namespace rcme
