// Which pairs are made of a rendered sequence, their files, their index, and work that was cut off.
#include <fmt/format.h>

#include <cmath>
#include <set>

#include "stats/constants.h"
#include "tests/test_support/dataset_checks.h"

namespace rcme {
namespace {

namespace fs = std::filesystem;

class MakePairs : public DatasetTest {
 protected:
  MakePairs()
      : DatasetTest("dataset",
                    [](const std::string& folder) { WriteKittiSequence(folder, "04", kNumRenderedFrames); }) {
  }
};

TEST_F(MakePairs, NeighboursGiveTriplesAndTheTruthsOwnErrorItsHeader) {
  PairsOptions options;
  options.neighbours = 2;
  options.truth_sd = {0.03, 0.012};
  const std::string out = folder_.Path("out");
  const std::vector<PairRow> rows = MakePairsInto(out, ReadKitti(MakeDatasetOptions(Folder())), options);
  std::set<std::pair<std::string, std::string>> kept;
  for (const PairRow& row : rows) {
    if (row.reason == kKeptPair) kept.emplace(row.image1, row.image2);
  }
  int num_triples = 0;
  for (const auto& [a, b] : kept) {
    for (const auto& [c, d] : kept) num_triples += b == c && kept.contains({a, d});
  }
  EXPECT_GE(num_triples, 1);
  const PairRow& row = rows.at(0);
  const TruthSd sd = SdOfMotion(*options.truth_sd, row.baseline);
  EXPECT_NEAR(sd.rotation_rad.x(), std::sqrt(2.0) * 0.03 / kDegPerRad, 1e-12);
  EXPECT_NEAR(sd.translation.y(), std::hypot(std::sqrt(2.0) * 0.012 / row.baseline, 0.03 / kDegPerRad),
              1e-12);
  for (const PairRow& each : rows) {
    if (each.reason != kKeptPair) continue;
    const MatchFile file = ReadMatchFile(out + "/" + each.pair_id + ".csv");
    ASSERT_TRUE(file.truth_sd.has_value());
    EXPECT_NEAR(file.truth_sd->translation.z(), SdOfMotion(*options.truth_sd, each.baseline).translation.z(),
                1e-9);
  }
}

// The error of a motion between two poses that err: against 20,000 draws; the standard error of a standard
// deviation is .5 %, the bound six of them (false alarm of the six numbers below 1e-7).
TEST(TruthSdOfPoses, IsThatOfDraws) {
  const PoseSd sd{0.5, 0.01};
  const CameraPose a{RotationFromVector({0.1, 0.2, -0.3}), {0.3, 0.1, 0.0}},
      b{RotationFromVector({0.4, 0, 0}), {1.3, 0.4, 0.7}};
  const TrueMotion12 exact = MotionBetween(a, b);
  RandomStream rng({.seed = 1, .purpose = 91});
  const auto noisy = [&](const CameraPose& pose) {
    const auto draw = [&](double s) {
      return Eigen::Vector3d(s * rng.Normal(), s * rng.Normal(), s * rng.Normal());
    };
    return CameraPose{pose.R_world_from_cam * RotationFromVector(draw(sd.rotation_deg / kDegPerRad)),
                      pose.center + draw(sd.position)};
  };
  constexpr int kDraws = 20'000;
  Eigen::Vector3d rotation2 = Eigen::Vector3d::Zero();
  double direction2 = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const TrueMotion12 drawn = MotionBetween(noisy(a), noisy(b));
    rotation2 += VectorFromRotation(drawn.cam2_from_cam1.R * exact.cam2_from_cam1.R.transpose())
                     .array()
                     .square()
                     .matrix();
    direction2 += std::pow(AngleBetween(drawn.cam2_from_cam1.t, exact.cam2_from_cam1.t), 2);
  }
  const TruthSd stated = SdOfMotion(sd, exact.baseline);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(std::sqrt(rotation2[i] / kDraws) / stated.rotation_rad[i], 1.0, 0.03);
  EXPECT_NEAR(std::sqrt(direction2 / kDraws / 2.0) / stated.translation[0], 1.0, 0.03);
}

TEST_F(MakePairs, WorkThatWasCutOffGoesOnAndGivesTheSameBytes) {
  const std::vector<Sequence> read = ReadKitti(MakeDatasetOptions(Folder()));
  PairsOptions options;
  options.neighbours = 2;
  options.cache = folder_.Path("cache");
  const std::string whole = folder_.Path("whole"), cut = folder_.Path("cut");
  const size_t num_rows = MakePairsInto(whole, read, options).size();
  ASSERT_GE(num_rows, 4u);
  fs::copy(whole, cut, fs::copy_options::recursive);
  const std::string journal = ReadBytes(whole + "/pairs.journal");
  // Cut within the third row; the files of what is behind are gone too.
  size_t at = 0;
  for (int line = 0; line < 3; ++line) at = journal.find('\n', at) + 1;
  std::ofstream(cut + "/pairs.journal", std::ios::binary) << journal.substr(0, at + 20);
  fs::remove(cut + "/INDEX.csv");
  {
    const PairJournal opened(cut, "test");
    EXPECT_EQ(opened.num_before(), 2);
    for (const fs::path& file : MatchFilesIn(cut)) {
      if (!opened.Find(ExtractPairId(file))) fs::remove(file);
    }
  }
  EXPECT_EQ(MakePairsInto(cut, read, options).size(), num_rows);
  for (const char* name : {"/INDEX.csv", "/pairs.txt", "/pairs.journal"})
    EXPECT_TRUE(ReadBytes(cut + name) == ReadBytes(whole + name)) << name;
  for (const fs::path& file : MatchFilesIn(whole))
    EXPECT_TRUE(ReadBytes(cut + "/" + file.filename().string()) == ReadBytes(file.string())) << file;
  EXPECT_TRUE(ThrowsInputError([&] { PairJournal(whole, "other"); }, {"--out: " + whole, "other options"}));
  std::ofstream(cut + "/pairs.journal", std::ios::binary) << "{}\n";
  EXPECT_TRUE(ThrowsInputError([&] { PairJournal(cut, "test"); }, {"pairs.journal:1: is damaged"}));
  folder_.Write("foreign.csv", "x");
  EXPECT_TRUE(ThrowsInputError([&] { PairJournal(folder_.path(), "test"); }, {"holds foreign.csv"}));
}

TEST_F(MakePairs, ADamagedImageIsSkippedCountedAndNamed) {
  const std::string copy = Copy(), out = folder_.Path("out");
  const std::string image = copy + "/sequences/04/image_0/000002.png";
  fs::resize_file(image, fs::file_size(image) / 2);
  std::ofstream(copy + "/sequences/04/image_0/000003.png", std::ios::binary) << "no image";
  MakePairsInto(out, ReadKitti(MakeDatasetOptions(copy)));
  const std::string text = ReadBytes(out + "/pairs.txt");
  for (const char* said : {"000002.png: the image is damaged: it ends early", "000003.png: is not a PNG"}) {
    const std::string line = "skipped: " + copy + "/sequences/04/image_0/";
    EXPECT_NE(text.find(line + said), std::string::npos) << text;
  }
  const PairJournal journal(out, "test");
  EXPECT_EQ(journal.damaged().size(), 2u);
  for (const PairRow& row : journal.rows()) {
    for (const char* damaged : {"image_0/000002.png", "image_0/000003.png"}) {
      EXPECT_NE(row.image1, damaged);
      EXPECT_NE(row.image2, damaged);
    }
  }
}

// Every third image, and pairs of these alone.
TEST_F(MakePairs, TakesEveryNthImage) {
  PairsOptions options;
  options.every = 3;
  options.gate.criterion.reset();
  const std::vector<PairRow> rows =
      MakePairsInto(folder_.Path("out"), ReadKitti(MakeDatasetOptions(Folder())), options);
  ASSERT_EQ(rows.size(), (kNumRenderedFrames + 2u) / 3u - 1u);
  EXPECT_EQ(rows[0].image1, "image_0/000000.png");
  EXPECT_EQ(rows[0].image2, "image_0/000003.png");
}

// Where two images have too few matches nothing before them waits any longer: only neighbours are tried.
TEST_F(MakePairs, BeginsAnewWhereMatchesAreTooFew) {
  PairsOptions options;
  options.neighbours = 3;
  options.gate.least_matches = 1'000'000;
  const std::vector<PairRow> rows =
      MakePairsInto(folder_.Path("out"), ReadKitti(MakeDatasetOptions(Folder())), options);
  ASSERT_EQ(rows.size(), kNumRenderedFrames - 1u);
  for (size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].reason, kTooFewMatches);
    EXPECT_EQ(rows[i].image2, fmt::format("image_0/{:06}.png", i + 1));
  }
}

TEST_F(MakePairs, MatchFilesAreJudgedAgain) {
  const std::string first = folder_.Path("first"), again = folder_.Path("again");
  PairsOptions options;
  options.gate.criterion.reset();  // all are kept
  const size_t num_pairs = MakePairsInto(first, ReadKitti(MakeDatasetOptions(Folder())), options).size();
  EXPECT_EQ(num_pairs, kNumRenderedFrames - 1u);
  DatasetOptions dataset;
  dataset.folder = first;
  PairJournal journal(again, "test");
  options.out = again;
  MakeListedPairs(*OpenMatchFiles(dataset), options, &journal);
  ASSERT_EQ(journal.rows().size(), num_pairs);
  for (const fs::path& path : MatchFilesIn(first)) {
    const MatchFile one = ReadMatchFile(path.string());
    const MatchFile other = ReadMatchFile(again + "/" + path.filename().string());
    EXPECT_EQ(one.sigma_px, other.sigma_px);
    EXPECT_EQ(one.matches.back().x2_px, other.matches.back().x2_px);
    EXPECT_LT((one.cam2_from_cam1_true->t - other.cam2_from_cam1_true->t).norm(), 1e-12);
  }
  PairJournal strict(folder_.Path("strict"), "test");
  options.out = folder_.Path("strict");
  options.gate = {ModelCriterion::kGric, 100'000};
  MakeListedPairs(*OpenMatchFiles(dataset), options, &strict);
  for (const PairRow& row : strict.rows()) EXPECT_EQ(row.reason, kTooFewMatches);
  const std::string table = PairsAsTable(strict.rows(), strict.damaged());
  EXPECT_NE(table.find("too_few_matches"), std::string::npos) << table;
}

}  // namespace
}  // namespace rcme
