#include <gtest/gtest.h>

#include <algorithm>

#include "simulator/outliers/outlier_laws.h"
#include "tests/simulator/outliers/wrong_matches.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/goodness_of_fit.h"

namespace rcme {
namespace {

// How many wrong matches share their noisy point in image 1, to the bit, with each true match.
std::vector<int> FanOuts(const DrawnOutliers& wrong, size_t num_wrong) {
  std::vector<int> fan_outs;
  for (size_t source = num_wrong; source < wrong.matches.size(); ++source) {
    fan_outs.push_back(static_cast<int>(std::count_if(
        wrong.matches.begin(), wrong.matches.begin() + static_cast<std::ptrdiff_t>(num_wrong),
        [&](const Correspondence& match) { return match.x1_px == wrong.matches[source].x1_px; })));
  }
  return fan_outs;
}

TEST(OneToManyOutliers, ShareThePointOfATrueMatch) {
  const Scene scene = SceneForOutliers(50);
  for (const int fan_out : {1, 3, 4}) {
    const auto law = WithSettings(MakeOneToManyOutliers(), {{"outlier_fan_out", std::to_string(fan_out)}});
    const std::vector<int> fan_outs = FanOuts(MakeWrong(*law, scene, 20, 0.5), 20);
    EXPECT_EQ(std::accumulate(fan_outs.begin(), fan_outs.end(), 0), 20) << "every one has a source";
    EXPECT_EQ(std::ranges::count(fan_outs, fan_out), 20 / fan_out);
    EXPECT_EQ(*std::ranges::max_element(fan_outs), fan_out);
  }
}

TEST(OneToManyOutliers, TakeTheTrueMatchesInTurnWhereTheyAreFew) {
  const std::vector<int> fan_outs =
      FanOuts(MakeWrong(*MakeOneToManyOutliers(), SceneForOutliers(50), 45, 0.5), 45);
  EXPECT_EQ(fan_outs, (std::vector<int>{9, 9, 9, 9, 9}));
}

// At 1e-4; not uniform in image 1's size, which is half as wide.
TEST(OneToManyOutliers, AreUniformInImage2) {
  const Scene scene = SceneForOutliers(3000);
  const DrawnOutliers wrong = MakeWrong(*MakeOneToManyOutliers(), scene, 2000, 0.5);
  std::vector<double> x, y, x_in_image1;
  for (size_t i = 0; i < 2000; ++i) {
    x.push_back((wrong.matches[i].x2_px.x() + 0.5) / scene.camera2.width);
    y.push_back((wrong.matches[i].x2_px.y() + 0.5) / scene.camera2.height);
    x_in_image1.push_back((wrong.matches[i].x2_px.x() + 0.5) / scene.camera1.width);
  }
  const auto uniform = [](double u) { return std::clamp(u, 0.0, 1.0); };
  EXPECT_GT(TestKolmogorovSmirnov(x, uniform).p_value, 1e-4);
  EXPECT_GT(TestKolmogorovSmirnov(y, uniform).p_value, 1e-4);
  EXPECT_LT(TestKolmogorovSmirnov(x_in_image1, uniform).p_value, 1e-10) << "no power";
}

TEST(OneToManyOutliers, WithoutTrueMatchesTheyNameTheKey) {
  EXPECT_TRUE(ThrowsInputError([] { MakeWrong(*MakeOneToManyOutliers(), SceneForOutliers(10), 10); },
                               {"outlier_ratio"}));
}

}  // namespace
}  // namespace rcme
