#include "experiments/data/colmap_camera.h"

#include <gtest/gtest.h>

#include "tests/test_support/expect_input_error.h"

namespace rcme {
namespace {

// COLMAP's models by number and name: where each has its parameters.
TEST(ColmapCamera, ParametersOfEveryModel) {
  struct Known {
    std::int64_t number;
    const char* name;
    bool has_one_focal_length;
    LensModel model;
    std::vector<double> k;  // of parameters 11, 12, 13, ... behind the principal point
  };
  const std::vector<Known> all = {
      {0, "SIMPLE_PINHOLE", true, LensModel::kPinhole, {}},
      {1, "PINHOLE", false, LensModel::kPinhole, {}},
      {2, "SIMPLE_RADIAL", true, LensModel::kRadtan, {11}},
      {3, "RADIAL", true, LensModel::kRadtan, {11, 12}},
      {4, "OPENCV", false, LensModel::kRadtan, {11, 12, 13, 14}},
      {5, "OPENCV_FISHEYE", false, LensModel::kFisheye, {11, 12, 13, 14}},
      {6, "FULL_OPENCV", false, LensModel::kRadtan, {11, 12, 13, 14, 15, 16, 17, 18}},
      {8, "SIMPLE_RADIAL_FISHEYE", true, LensModel::kFisheye, {11}},
      {9, "RADIAL_FISHEYE", true, LensModel::kFisheye, {11, 12}}};
  for (const Known& known : all) {
    std::vector<double> p = {500.0, 510.0, 320.0, 240.0};
    if (known.has_one_focal_length) p.erase(p.begin() + 1);
    p.insert(p.end(), known.k.begin(), known.k.end());
    EXPECT_EQ(ColmapModelNumber(known.name, ""), known.number);
    EXPECT_EQ(NumColmapParameters(known.number, ""), p.size()) << known.name;
    const Lens lens = LensOfColmapCamera({known.number, 640, 480, p}, "");
    EXPECT_EQ(lens.model, known.model) << known.name;
    EXPECT_EQ(lens.camera.fx, 500.0);
    EXPECT_EQ(lens.camera.fy, known.has_one_focal_length ? 500.0 : 510.0) << known.name;
    EXPECT_EQ(lens.camera.cx, 319.5);
    EXPECT_EQ(lens.camera.cy, 239.5);
    for (size_t i = 0; i < lens.k.size(); ++i)
      EXPECT_EQ(lens.k[i], i < known.k.size() ? known.k[i] : 0.0) << known.name << " " << i;
  }
  EXPECT_TRUE(
      ThrowsInputError([] { NumColmapParameters(7, "db: camera 3"); }, {"db: camera 3: model '7' is not"}));
}

// In words the same, without COLMAP's half pixel, with and without the size.
TEST(ColmapCamera, InWords) {
  const Lens lens =
      LensFromWords({"OPENCV", "640", "480", "500", "510", "320", "240", "-0.1", "0.2", "1e-3", "2e-3"}, "");
  EXPECT_EQ(lens.model, LensModel::kRadtan);
  EXPECT_EQ(lens.camera.cx, 320.0);
  EXPECT_EQ(lens.camera.cy, 240.0);
  EXPECT_EQ(lens.camera.height, 480);
  EXPECT_EQ(lens.k[3], 2e-3);
  const Lens without =
      LensWithoutSizeFromWords({"OPENCV", "500", "510", "320", "240", "-0.1", "0.2", "1e-3", "2e-3"}, "");
  EXPECT_EQ(without.k, lens.k);
  EXPECT_EQ(without.camera.fy, 510.0);
  EXPECT_EQ(without.camera.width, 0);
  EXPECT_TRUE(ThrowsInputError([] { LensFromWords({}, "x"); }, {"x: give a model, width and height"}));
  EXPECT_TRUE(ThrowsInputError([] { LensWithoutSizeFromWords({}, "x"); }, {"x: model '' is not supported"}));
  EXPECT_TRUE(ThrowsInputError(
      [] {
        LensWithoutSizeFromWords({"PINHOLE", "1", "1", "nan", "1"}, "x");
      },
      {"x: 'nan' is not a finite number"}));
  EXPECT_TRUE(ThrowsInputError(
      [] {
        LensFromWords({"PINHOLE", "1e7", "1", "1", "1", "1", "1"}, "x");
      },
      {"x: an image of 10000000 x 1 px"}));
}

}  // namespace
}  // namespace rcme
