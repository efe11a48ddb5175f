#include <gtest/gtest.h>

#include "parameters/settings.h"

namespace rcme {
namespace {

TEST(FindSetting, LaterEntriesOverrideEarlierOnes) {
  const Settings settings = {{"scene", "plane"}, {"sigma_px", "0.5"}, {"scene", "indoor"}};
  EXPECT_EQ(FindSetting(settings, "scene"), "indoor");
  EXPECT_EQ(FindSetting(settings, "sigma_px"), "0.5");
  EXPECT_EQ(FindSetting(settings, "sigma"), std::nullopt);
  EXPECT_EQ(FindSetting({}, "scene"), std::nullopt);
}

}  // namespace
}  // namespace rcme
