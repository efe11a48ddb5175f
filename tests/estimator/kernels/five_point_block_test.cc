// Eight five-point samples side by side against the scalar solver and against the truth, on every instruction
// set.
#include "estimator/kernels/five_point_block.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "estimator/geometry/essential_matrix.h"
#include "estimator/solvers/five_point.h"
#include "stats/constants.h"
#include "tests/test_support/coverage_count.h"
#include "tests/test_support/every_target.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

class FivePointBlockTest : public OnEveryTarget {};

struct Rays {
  FivePoint::Rays first, second;  // z = 1
};
using Eight = std::array<Rays, kBlockSize>;
using Matrices = std::vector<Eigen::Matrix3d>;

// `true_share_of_others` is how often the most used fast solver (PoseLib 2.0's relpose_5pt) has the true E
// among its solutions to 1e-4, on exact matches of a family such as this: what ours has to reach.
struct Family {
  std::string name;
  double baseline;  // over the distance of the scene
  bool is_forward, is_planar;
  double true_share_of_others;
};
const std::vector<Family>& Families() {
  static const std::vector<Family> all = {{"generic", 0.1, false, false, 0.980},
                                          {"forward", 0.1, true, false, 0.955},
                                          {"planar", 0.1, false, true, 0.949},
                                          {"small baseline", 0.01, false, false, 0.81}};
  return all;
}

RelativePose DrawPose(const Family& family, RandomStream& rng) {
  RelativePose pose = RandomPose(rng, 20.0);
  if (family.is_forward) pose.t = Eigen::Vector3d(0.02 * rng.Normal(), 0.02 * rng.Normal(), 1.0).normalized();
  return pose;
}

// Matches exact but for noise of a standard deviation `sigma` in each coordinate; points 2 to 8 away.
Rays DrawRays(const Family& family, const RelativePose& pose, double sigma, RandomStream& rng) {
  Rays rays;
  const Eigen::Vector3d normal(0.3 * rng.Normal(), 0.3 * rng.Normal(), 1.0);
  for (size_t k = 0; k < 5;) {
    const Eigen::Vector3d ray(rng.Uniform(-0.45, 0.45), rng.Uniform(-0.34, 0.34), 1.0);
    const double depth = family.is_planar ? 5.0 / normal.dot(ray) : rng.Uniform(2.0, 8.0);
    const Eigen::Vector3d in_cam2 = pose.R * (depth * ray) + 5.0 * family.baseline * pose.t;
    if (depth < 0.3 || in_cam2.z() < 0.3) continue;
    rays.first[k] = ray + sigma * Eigen::Vector3d(rng.Normal(), rng.Normal(), 0.0);
    rays.second[k++] = in_cam2 / in_cam2.z() + sigma * Eigen::Vector3d(rng.Normal(), rng.Normal(), 0.0);
  }
  return rays;
}

// Eight samples of one family, each of a motion of its own.
struct EightSamples {
  Eight samples;
  std::array<Eigen::Matrix3d, kBlockSize> E_true;
};
EightSamples DrawSamples(const Family& family, double sigma, RandomStream& rng) {
  EightSamples c;
  for (size_t s = 0; s < kBlockSize; ++s) {
    const RelativePose pose = DrawPose(family, rng);
    c.samples[s] = DrawRays(family, pose, sigma, rng);
    c.E_true[s] = EssentialFromPose(pose);
  }
  return c;
}
EightSamples DrawSamples(std::uint32_t trial) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 2630});
  return DrawSamples(Families()[trial % Families().size()], 1e-3, rng);
}

FivePointModels Solve(const Eight& samples) {
  FivePointSamples block;
  for (size_t s = 0; s < kBlockSize; ++s) {
    for (size_t k = 0; k < 5; ++k) {
      block.x1[k][s] = samples[s].first[k].x();
      block.y1[k][s] = samples[s].first[k].y();
      block.x2[k][s] = samples[s].second[k].x();
      block.y2[k][s] = samples[s].second[k].y();
    }
  }
  FivePointModels models;
  SolveFivePoints(block, &models);
  return models;
}

Matrices ListModels(const FivePointModels& models, size_t sample) {
  Matrices matrices;
  for (int m = models.begin[sample]; m < models.begin[sample + 1]; ++m) {
    Eigen::Matrix3d E;
    for (int i = 0; i < 9; ++i) E(i / 3, i % 3) = models.E[i][m];
    matrices.push_back(E);
  }
  return matrices;
}
Matrices SolveReference(const Rays& rays) {
  const FivePoint::Solutions solutions = FivePoint::Solve(rays.first, rays.second);
  return {solutions.E.begin(), solutions.E.begin() + solutions.count};
}

// 2, further than any can be, if there is none.
double DistanceToNearest(const Eigen::Matrix3d& E, const Matrices& others) {
  double nearest = 2.0;
  for (const Eigen::Matrix3d& other : others) {
    nearest = std::min({nearest, (E - other).norm(), (E + other).norm()});
  }
  return nearest;
}

// The greatest of the five epipolar equations of unit rays, the nine trace constraints, and the norm's error.
double GreatestViolation(const Eigen::Matrix3d& E, const Rays& rays) {
  const Eigen::Matrix3d EEt = E * E.transpose();
  double greatest =
      std::max((2.0 * EEt * E - EEt.trace() * E).cwiseAbs().maxCoeff(), std::abs(EEt.trace() - 2.0));
  for (size_t k = 0; k < 5; ++k) {
    greatest = std::max(greatest, std::abs(rays.second[k].normalized().dot(E * rays.first[k].normalized())));
  }
  return greatest;
}

// Would catch an entry in the wrong place, a wrong norm, and roots that the polish did not settle.
TEST_F(FivePointBlockTest, EveryModelMeetsTheConstraints) {
  Run([] {
    int num_models = 0;
    double greatest = 0.0;
    for (std::uint32_t trial = 0; trial < 100; ++trial) {
      const EightSamples c = DrawSamples(trial);
      const FivePointModels models = Solve(c.samples);
      ASSERT_EQ(models.begin[0], 0);
      for (size_t s = 0; s < kBlockSize; ++s) {
        const Matrices of_sample = ListModels(models, s);
        EXPECT_LE(of_sample.size(), 10u);
        for (const Eigen::Matrix3d& E : of_sample)
          greatest = std::max(greatest, GreatestViolation(E, c.samples[s]));
      }
      num_models += models.count();
    }
    EXPECT_LT(greatest, 1e-9);
    EXPECT_GT(num_models, 4 * 100 * kBlockSize);
  });
}

// 4000 exact samples a family. The exact interval of the rate (confidence .9999) lies above what is asked.
TEST_F(FivePointBlockTest, HasTheTruthMoreOftenThanOthers) {
  for (const Family& family : Families()) {
    RandomStream rng({.seed = 1, .purpose = 2631});
    CoverageCount has_truth;
    for (int block = 0; block < 500; ++block) {
      const EightSamples c = DrawSamples(family, 0.0, rng);
      const FivePointModels models = Solve(c.samples);
      for (size_t s = 0; s < kBlockSize; ++s) {
        has_truth.Add(DistanceToNearest(c.E_true[s], ListModels(models, s)) < 1e-4);
      }
    }
    EXPECT_GT(has_truth.interval().lower, family.true_share_of_others) << family.name << ": " << has_truth;
    RecordProperty(family.name, testing::PrintToString(has_truth));
  }
}

// Noisy samples: of the scalar solver's solutions it may miss some of a pair that nearly coincides, and has
// none that the scalar solver has not.
TEST_F(FivePointBlockTest, HasTheSolutionsOfTheScalarSolver) {
  for (const Family& family : Families()) {
    RandomStream rng({.seed = 1, .purpose = 2632});
    CoverageCount is_found, is_solution;
    for (int block = 0; block < 100; ++block) {
      const EightSamples c = DrawSamples(family, 1e-3, rng);
      const FivePointModels models = Solve(c.samples);
      for (size_t s = 0; s < kBlockSize; ++s) {
        const Matrices ours = ListModels(models, s), reference = SolveReference(c.samples[s]);
        for (const Eigen::Matrix3d& E : reference) is_found.Add(DistanceToNearest(E, ours) < 1e-6);
        for (const Eigen::Matrix3d& E : ours) is_solution.Add(DistanceToNearest(E, reference) < 1e-6);
      }
    }
    EXPECT_GT(is_found.interval().lower, 0.97) << family.name << ": " << is_found;
    EXPECT_GT(is_solution.interval().lower, 0.995) << family.name << ": " << is_solution;
    RecordProperty(family.name + "_found", testing::PrintToString(is_found));
    RecordProperty(family.name + "_solutions", testing::PrintToString(is_solution));
  }
}

using SpoilRays = std::function<void(Rays*)>;
const std::vector<std::pair<std::string, SpoilRays>>& DegenerateRays() {
  static const std::vector<std::pair<std::string, SpoilRays>> all = {
      {"a match twice", [](Rays* r) { r->first[3] = r->first[1], r->second[3] = r->second[1]; }},
      {"one match only", [](Rays* r) { r->first.fill(r->first[0]), r->second.fill(r->second[0]); }},
      {"points on a line of space",
       [](Rays* r) {
         const Eigen::Vector3d a(-0.5, 0.3, 4.0), along(0.4, -0.1, 0.7), t(0.2, 0.5, 0.1);
         for (size_t k = 0; k < 5; ++k) {
           const Eigen::Vector3d point = a + static_cast<double>(k) * along;
           r->first[k] = point / point.z();
           r->second[k] = (point + t) / (point + t).z();
         }
       }},
      {"a rotation",
       [](Rays* r) {
         const Eigen::Matrix3d R = RotationFromVector(Eigen::Vector3d(0.1, -0.2, 0.15));
         for (size_t k = 0; k < 5; ++k) {
           r->second[k] = R * r->first[k];
           r->second[k] /= r->second[k].z();
         }
       }},
      {"no motion", [](Rays* r) { r->second = r->first; }},
      {"zeros", [](Rays* r) { r->first.fill(Eigen::Vector3d::Zero()), r->second = r->first; }},
      {"not a number", [](Rays* r) { r->second[2].y() = kNaN; }},
      {"infinite", [](Rays* r) { r->first[0].x() = kInfinity; }},
      {"too great", [](Rays* r) { r->first[4].x() = std::numeric_limits<double>::max(); }},
      {"all not a number",
       [](Rays* r) { r->first.fill(Eigen::Vector3d::Constant(kNaN)), r->second = r->first; }},
  };
  return all;
}

TEST_F(FivePointBlockTest, DegenerateSamplesHaveNoModels) {
  Run([] {
    for (const auto& [name, spoil] : DegenerateRays()) {
      for (std::uint32_t trial = 0; trial < 24; ++trial) {
        EightSamples c = DrawSamples(trial);
        const size_t spoilt = trial % kBlockSize;
        spoil(&c.samples[spoilt]);
        EXPECT_TRUE(ListModels(Solve(c.samples), spoilt).empty()) << name << ", trial " << trial;
      }
    }
  });
}

TEST_F(FivePointBlockTest, ASampleDoesNotTouchTheOthers) {
  Run([] {
    for (const auto& [name, spoil] : DegenerateRays()) {
      for (size_t spoilt = 0; spoilt < kBlockSize; ++spoilt) {
        EightSamples c = DrawSamples(100 + static_cast<std::uint32_t>(spoilt));
        const FivePointModels without = Solve(c.samples);
        spoil(&c.samples[spoilt]);
        const FivePointModels with = Solve(c.samples);
        for (size_t s = 0; s < kBlockSize; ++s) {
          if (s == spoilt) continue;
          EXPECT_EQ(ListModels(with, s), ListModels(without, s)) << name;
        }
      }
    }
  });
}

TEST_F(FivePointBlockTest, EveryLaneGivesTheSameBits) {
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    EightSamples c = DrawSamples(200 + trial);
    c.samples.fill(c.samples[trial % kBlockSize]);
    Run([&] {
      const FivePointModels models = Solve(c.samples);
      for (size_t s = 1; s < kBlockSize; ++s) EXPECT_EQ(ListModels(models, s), ListModels(models, 0));
    });
  }
}

TEST_F(FivePointBlockTest, EveryInstructionSetGivesTheSameBits) {
  for (std::uint32_t trial = 0; trial < 200; ++trial) {
    EightSamples c = DrawSamples(300 + trial);
    const auto& spoil = DegenerateRays()[trial % DegenerateRays().size()].second;
    if (trial % 2 == 0) spoil(&c.samples[trial % kBlockSize]);
    const FivePointModels best = Solve(c.samples);
    Run([&] {
      const FivePointModels models = Solve(c.samples);
      ASSERT_EQ(std::memcmp(models.begin, best.begin, sizeof(best.begin)), 0);
      for (int i = 0; i < 9; ++i) {
        const size_t size = static_cast<size_t>(best.count()) * sizeof(double);
        EXPECT_EQ(std::memcmp(models.E[i], best.E[i], size), 0) << "trial " << trial;
      }
    });
  }
}

}  // namespace
}  // namespace rcme
