#include "experiments/real/sequences/layout_files.h"

#include <gtest/gtest.h>

#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

std::vector<std::vector<std::string>> ReadRows(const std::string& text, TableFile::Separator separator) {
  const TempFolder folder;
  std::vector<std::vector<std::string>> rows;
  for (TableFile table(folder.Write("table.txt", text), "", separator); table.Next();)
    rows.push_back(table.fields());
  return rows;
}

// Between commas a field may be empty, at the end of the line too; blanks around it do not count.
TEST(TableFile, SplitsRowsByHand) {
  using Row = std::vector<std::string>;
  EXPECT_EQ(ReadRows("# head\n1, two ,\n\n,3\n", TableFile::Separator::kComma),
            (std::vector<Row>{{"1", "two", ""}, {"", "3"}}));
  EXPECT_EQ(ReadRows("  1\t two  \n#2\n3\r\n", TableFile::Separator::kSpace),
            (std::vector<Row>{{"1", "two"}, {"3"}}));
}

TEST(TableFile, RefusesMoreRowsThanItIsAskedFor) {
  const TempFolder folder;
  const std::string path = folder.Write("table.txt", "1\n2\n3\n");
  const auto read = [&](int max_rows) {
    int num_rows = 0;
    for (TableFile table(path, "", TableFile::Separator::kSpace, max_rows); table.Next();) ++num_rows;
    return num_rows;
  };
  EXPECT_EQ(read(3), 3);
  EXPECT_TRUE(ThrowsInputError([&] { read(2); }, {"table.txt", "more rows"}));
}

// The first frames, as many as asked for; images that are not looked at need not be there.
TEST(FinishSequence, CutsToTheFramesAskedFor) {
  const TempFolder folder;
  Sequence sequence;
  sequence.name = "made";
  sequence.lens.camera = {100.0, 100.0, 50.0, 50.0, 101, 101};
  for (int i = 0; i < 4; ++i) {
    const std::string name = std::to_string(i) + ".pgm";
    if (i < 2) folder.Write(name, "P5\n101 101\n255\n");
    sequence.frames.push_back({name, folder.Path(name), 1.0 * i, std::nullopt});
  }
  DatasetOptions options;
  options.max_frames = 2;
  FinishSequence(options, folder.Path("times.txt"), &sequence);
  EXPECT_EQ(sequence.frames.size(), 2u);
  options.max_frames = 1;
  EXPECT_TRUE(
      ThrowsInputError([&] { FinishSequence(options, "times.txt", &sequence); }, {"a pair needs two"}));
}

}  // namespace
}  // namespace rcme
