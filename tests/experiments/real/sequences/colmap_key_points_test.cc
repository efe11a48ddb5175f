// Key points and matches of a database of COLMAP, row by row; no image is read.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include <cmath>

#include "experiments/real/images/features.h"
#include "experiments/real/sequences/listed_pairs.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

// Two images of one pinhole camera with the rows given, `width` numbers each, and the matches given.
class Database {
 public:
  Database(const std::vector<float>& points1, const std::vector<float>& points2, int width,
           const std::vector<std::uint32_t>& matches) {
    SQLite::Database database(path_, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    database.exec(
        "CREATE TABLE cameras (camera_id INTEGER PRIMARY KEY, model INTEGER, width INTEGER, height INTEGER, "
        "params BLOB, prior_focal_length INTEGER);"
        "CREATE TABLE images (image_id INTEGER PRIMARY KEY, name TEXT UNIQUE, camera_id INTEGER);"
        "CREATE TABLE keypoints (image_id INTEGER PRIMARY KEY, rows INTEGER, cols INTEGER, data BLOB);"
        "CREATE TABLE matches (pair_id INTEGER PRIMARY KEY, rows INTEGER, cols INTEGER, data BLOB);"
        "INSERT INTO images VALUES (1, 'a.png', 1), (2, 'b.png', 1);");
    const std::vector<double> K = {300.0, 300.0, 320.5, 240.5};
    SQLite::Statement camera(database, "INSERT INTO cameras VALUES (1, 1, 640, 480, ?, 0)");
    camera.bind(1, K.data(), static_cast<int>(K.size() * sizeof(double)));
    camera.exec();
    Insert(&database, "keypoints", 1, points1, width);
    Insert(&database, "keypoints", 2, points2, width);
    Insert(&database, "matches", 2147483647LL + 2, matches, 2);
  }

  ListedPair Read() const {
    DatasetOptions options;
    options.folder = path_;
    return OpenColmap(options)->Read(0);
  }

 private:
  template <typename Number>
  static void Insert(SQLite::Database* database, const std::string& table, std::int64_t id,
                     const std::vector<Number>& data, int width) {
    SQLite::Statement row(*database, "INSERT INTO " + table + " VALUES (?, ?, ?, ?)");
    row.bind(1, id);
    row.bind(2, static_cast<std::int64_t>(data.size()) / width);
    row.bind(3, width);
    row.bind(4, data.data(), static_cast<int>(data.size() * sizeof(Number)));
    row.exec();
  }

  TempFolder folder_;
  std::string path_ = folder_.Path("database.db");
};

double SigmaOfSizes(float size1, float size2) {
  return SigmaOfMatch(Detector::kSift, {0.0f, 0.0f, size1}, {0.0f, 0.0f, size2});
}

// A scale of 3 and one of 5: diameters of 6 and 10. Pixels are half a pixel less than COLMAP's.
TEST(ColmapKeyPoints, WithAScaleHaveTwiceThatAsTheirSize) {
  const MatchFile file =
      Database({100.5f, 50.5f, 3.0f, 0.0f}, {110.5f, 60.5f, 5.0f, 0.0f}, 4, {0, 0}).Read().file;
  ASSERT_EQ(file.matches.size(), 1u);
  EXPECT_EQ(file.matches[0].x1_px, Eigen::Vector2d(100.0, 50.0));
  EXPECT_EQ(file.matches[0].x2_px, Eigen::Vector2d(110.0, 60.0));
  ASSERT_EQ(file.sigma_px.size(), 1u);
  EXPECT_NEAR(file.sigma_px[0], SigmaOfSizes(6.0f, 10.0f), 1e-9);
}

// A shape (a11 a12; a21 a22): the lengths of its columns, (3, 4) and (0, 2), add up to 7; those of its rows,
// 3 and sqrt(20), would not.
TEST(ColmapKeyPoints, WithAShapeHaveTheLengthsOfItsColumns) {
  const MatchFile file =
      Database({100.5f, 50.5f, 3.0f, 0.0f, 4.0f, 2.0f}, {110.5f, 60.5f, 1.0f, 0.0f, 0.0f, 1.0f}, 6, {0, 0})
          .Read()
          .file;
  ASSERT_EQ(file.sigma_px.size(), 1u);
  EXPECT_NEAR(file.sigma_px[0], SigmaOfSizes(7.0f, 2.0f), 1e-9);
}

TEST(ColmapKeyPoints, WithoutSizesStateNoNoise) {
  EXPECT_TRUE(Database({100.5f, 50.5f}, {110.5f, 60.5f}, 2, {0, 0}).Read().file.sigma_px.empty());
  // Of one point the scale is zero: then nothing is said of any match.
  const MatchFile file = Database({100.5f, 50.5f, 3.0f, 0.0f, 90.5f, 50.5f, 0.0f, 0.0f},
                                  {110.5f, 60.5f, 5.0f, 0.0f, 99.5f, 60.5f, 5.0f, 0.0f}, 4, {0, 0, 1, 1})
                             .Read()
                             .file;
  EXPECT_EQ(file.matches.size(), 2u);
  EXPECT_TRUE(file.sigma_px.empty());
}

TEST(ColmapKeyPoints, ThatAreNotThereAreRefused) {
  for (const std::vector<std::uint32_t>& match : {std::vector<std::uint32_t>{1, 0}, {0, 1}, {7, 0}}) {
    const Database database({100.5f, 50.5f}, {110.5f, 60.5f}, 2, match);
    EXPECT_TRUE(
        ThrowsInputError([&] { database.Read(); }, {"matches of pair", "key point that is not there"}));
  }
}

}  // namespace
}  // namespace rcme
