// The contract of every outlier law in the registry: a new law is tested by its line there.
#include "simulator/outlier_registry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "parameters/input_error.h"
#include "simulator/camera_registry.h"
#include "simulator/motion_registry.h"
#include "simulator/noise/noise_laws.h"
#include "simulator/noise_registry.h"
#include "simulator/observe.h"
#include "simulator/scene_registry.h"
#include "tests/simulator/outliers/wrong_matches.h"

namespace rcme {
namespace {

class OutlierContract : public testing::TestWithParam<OutlierEntry> {
 protected:
  static Observation ObserveWith(const Scene& scene, double sigma_px, double ratio, std::uint32_t trial = 0) {
    RandomStream noise_rng({1, 0, trial, 2}), outlier_rng({1, 0, trial, 3});
    const OutlierModel outliers(GetParam().make(), ratio);
    return Observe(scene, *MakeGaussianNoise(sigma_px), outliers, noise_rng, outlier_rng);
  }
};

// The matches as a set: observations come shuffled.
using Numbers = std::array<double, 4>;
std::multiset<Numbers> Matches(const Observation& observation, bool only_inliers) {
  std::multiset<Numbers> all;
  for (size_t i = 0; i < observation.matches.size(); ++i) {
    const Correspondence& match = observation.matches[i];
    if (only_inliers && !observation.is_inlier_true[i]) continue;
    all.insert({match.x1_px.x(), match.x1_px.y(), match.x2_px.x(), match.x2_px.y()});
  }
  return all;
}

template <typename Entry>
std::set<std::string> Keys(const std::vector<Entry>& registry) {
  std::set<std::string> keys;
  for (const Entry& entry : registry) {
    const auto model = entry.make();
    for (const Parameter& parameter : model->Parameters()) keys.insert(parameter.name());
  }
  return keys;
}

TEST_P(OutlierContract, ItsParametersHaveNamesOfTheirOwnAndSurviveARoundTrip) {
  OutlierModel outliers(GetParam().make());
  std::set<std::string> names;
  for (const std::set<std::string>& others :
       {Keys(SceneRegistry()), Keys(CameraRegistry()), Keys(MotionRegistry()), Keys(NoiseRegistry())}) {
    names.insert(others.begin(), others.end());
  }
  for (const Parameter& parameter : Parameters(outliers)) {
    EXPECT_TRUE(names.insert(parameter.name()).second) << parameter.name();
    EXPECT_FALSE(parameter.doc().empty()) << parameter.name();
    const std::string value = parameter.Value();
    parameter.SetFromText(value);
    EXPECT_EQ(parameter.Value(), value);
  }
}

TEST_P(OutlierContract, TheCountIsExactAndNoInlierIsTouched) {
  for (const int n : {7, 200}) {
    const Scene scene = SceneForOutliers(n);
    const std::multiset<Numbers> clean = Matches(ObserveWith(scene, 0.5, 0.0), true);
    ASSERT_EQ(clean.size(), static_cast<size_t>(n));
    for (const double ratio : {0.1, 0.25, 0.5, 0.75}) {
      const Observation observation = ObserveWith(scene, 0.5, ratio);
      const auto num_outliers = std::ranges::count(observation.is_inlier_true, false);
      EXPECT_EQ(num_outliers, std::lround(ratio * n));
      const std::multiset<Numbers> inliers = Matches(observation, true);
      EXPECT_TRUE(std::ranges::includes(clean, inliers));  // to the bit: noise does not depend on outliers
      std::multiset<Numbers> both;
      std::ranges::set_intersection(clean, Matches(observation, false), std::inserter(both, both.end()));
      EXPECT_EQ(both.size(), inliers.size()) << "every outlier is another match than before";
      for (size_t i = 0; i < static_cast<size_t>(n); ++i) {
        EXPECT_FALSE(observation.is_inlier_true[i] && observation.is_undetectable[i]);
      }
    }
  }
}

TEST_P(OutlierContract, BothEndsLieInTheirImagesButForNoise) {
  for (const char* motion : {"general", "forward", "orbit"}) {
    for (std::uint32_t trial = 0; trial < 20; ++trial) {
      const Scene scene = SceneForOutliers(100, trial, motion);
      for (const Correspondence& match : MakeWrong(*GetParam().make(), scene, 60, 0.0, trial).matches) {
        ASSERT_TRUE(scene.camera1.IsInImage(match.x1_px)) << motion;
        ASSERT_TRUE(scene.camera2.IsInImage(match.x2_px)) << motion;
      }
    }
  }
}

// Flagged are those that satisfy the true epipolar constraint before noise, which no law but `epipolar` does
// more often than by chance: within 1e-12 never.
TEST_P(OutlierContract, FlaggedAreThoseOnTheTrueEpipolarLine) {
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    const Scene scene = SceneForOutliers(100, trial);
    const DrawnOutliers wrong = MakeWrong(*GetParam().make(), scene, 60, 0.0, trial);
    for (size_t i = 0; i < 100; ++i) {
      EXPECT_EQ(wrong.is_undetectable[i], i < 60 && std::abs(TripleProduct(scene, wrong.matches[i])) < 1e-12);
      EXPECT_EQ(wrong.is_undetectable[i], i < 60 && GetParam().name == "epipolar");
    }
  }
}

TEST_P(OutlierContract, IsAPureFunctionOfTheStreams) {
  const Scene scene = SceneForOutliers(100);
  const Observation a = ObserveWith(scene, 0.5, 0.4, 7), b = ObserveWith(scene, 0.5, 0.4, 7);
  const Observation c = ObserveWith(scene, 0.5, 0.4, 8);
  EXPECT_TRUE(std::ranges::equal(a.matches, b.matches, AreEqual));
  EXPECT_EQ(a.is_inlier_true, b.is_inlier_true);
  EXPECT_EQ(a.is_undetectable, b.is_undetectable);
  EXPECT_FALSE(std::ranges::equal(a.matches, c.matches, AreEqual));
}

// Without wrong matches a law has nothing to object to, not even where it could not make any; with wrong
// matches alone it gives a result or names the keys.
TEST_P(OutlierContract, NoneAndAllWrongAreDefined) {
  Scene bare = SceneForOutliers(20, 0, "pure_rotation");
  bare.repeat_steps_m.clear();
  EXPECT_EQ(Matches(ObserveWith(bare, 0.5, 0.0), true).size(), 20u);
  for (const Scene& scene : {bare, SceneForOutliers(20)}) {
    try {
      const Observation observation = ObserveWith(scene, 0.5, 1.0);
      EXPECT_EQ(std::ranges::count(observation.is_inlier_true, false), 20);
      for (const Correspondence& match : observation.matches) {
        EXPECT_TRUE(match.x1_px.allFinite() && match.x2_px.allFinite());
      }
    } catch (const InputError& error) {
      const std::string message = error.what();
      bool names_a_key = message.find("outlier_ratio") != std::string::npos ||
                         message.find("baseline_m") != std::string::npos;
      for (const Parameter& parameter : GetParam().make()->Parameters()) {
        names_a_key = names_a_key || message.find(parameter.name()) != std::string::npos;
      }
      EXPECT_TRUE(names_a_key) << message;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Registry, OutlierContract, testing::ValuesIn(OutlierRegistry()),
                         [](const auto& law) { return law.param.name; });

// A key that several laws have means the same in all of them: `mixture` sets them together.
TEST(OutlierRegistry, LawsThatShareAKeyAgreeOnIt) {
  std::map<std::string, std::vector<std::string>> known;
  for (const OutlierEntry& entry : OutlierRegistry()) {
    const auto law = entry.make();
    for (const Parameter& p : law->Parameters()) {
      const std::vector<std::string> description = {p.Value(), p.unit(), p.allowed(), p.doc()};
      EXPECT_EQ(known.emplace(p.name(), description).first->second, description)
          << entry.name << " " << p.name();
    }
  }
}

}  // namespace
}  // namespace rcme
