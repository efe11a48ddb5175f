// What the journal of pairs remembers, and the tables made of it.
#include "experiments/real/sequences/pair_index.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/real/sequences/key_frame_gate.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

PairRow MakePairRow(const std::string& pair_id, const std::string& scene, const std::string& reason) {
  PairRow row;
  row.pair_id = pair_id;
  row.scene = scene;
  row.reason = reason;
  row.num_matches = 120;
  return row;
}

// A kept pair whose file is gone is to be made again; a dropped one has none and stays.
TEST(PairJournal, ForgetsKeptPairsWithoutTheirFile) {
  const TempFolder folder;
  const std::string out = folder.Path("out");
  {
    PairJournal journal(out, "same");
    journal.Add(MakePairRow("with", "hall", kKeptPair));
    journal.Add(MakePairRow("without", "hall", kKeptPair));
    journal.Add(MakePairRow("dropped", "hall", "planar_scene"));
  }
  std::ofstream(out + "/with.csv") << "x\n";
  const PairJournal again(out, "same");
  EXPECT_EQ(again.num_before(), 2);
  ASSERT_NE(again.Find("with"), nullptr);
  EXPECT_EQ(again.Find("with")->num_matches, 120);
  EXPECT_TRUE(std::isnan(again.Find("with")->baseline));
  EXPECT_EQ(again.Find("without"), nullptr);
  EXPECT_NE(again.Find("dropped"), nullptr);
}

TEST(PairJournal, IsOfOneProcessAtATime) {
  const TempFolder folder;
  const std::string out = folder.Path("out");
  {
    PairJournal journal(out, "same");
    EXPECT_TRUE(ThrowsInputError([&] { PairJournal(out, "same"); }, {"another process makes pairs in", out}));
    journal.Add(MakePairRow("dropped", "hall", "planar_scene"));
  }
  EXPECT_EQ(PairJournal(out, "same").num_before(), 1);
}

// An image is damaged in its own scene; another scene may have one of that name.
TEST(PairJournal, KnowsDamagedImagesByTheirScene) {
  const TempFolder folder;
  const std::string out = folder.Path("out");
  {
    PairJournal journal(out, "same");
    journal.Add(DamagedImage{"hall", "1.png", "hall's is damaged"});
  }
  const PairJournal again(out, "same");
  ASSERT_NE(again.FindDamaged("hall", "1.png"), nullptr);
  EXPECT_EQ(again.FindDamaged("hall", "1.png")->message, "hall's is damaged");
  EXPECT_EQ(again.FindDamaged("yard", "1.png"), nullptr);
  EXPECT_EQ(again.FindDamaged("hall", "2.png"), nullptr);
}

// Of the pairs that were kept those count whose motion is known.
TEST(PairsAsTable, CountsByScene) {
  PairRow known = MakePairRow("a", "hall", kKeptPair), dropped = MakePairRow("c", "hall", "planar_scene");
  known.rotation_deg = dropped.rotation_deg = 1.0;
  const std::string table =
      PairsAsTable({known, MakePairRow("b", "hall", kKeptPair), dropped, MakePairRow("d", "yard", kKeptPair)},
                   {{"yard", "1.png", "is cut off"}});
  EXPECT_THAT(table, testing::ContainsRegex("hall +3 +2 +1 +1 +0"));
  EXPECT_THAT(table, testing::ContainsRegex("yard +1 +1 +0 +0 +1"));
  EXPECT_THAT(table, testing::HasSubstr("skipped: is cut off\n"));
}

}  // namespace
}  // namespace rcme
