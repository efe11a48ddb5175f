// Small inputs that would fill memory or never end. Each is refused with a message that says what is allowed,
// and what that takes at its peak is measured. Without the limits a match file of 102 kB took 6 GB, an image
// of 140 kB 11 GB.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "experiments/core/files/gzip_lines.h"
#include "experiments/core/files/sha256.h"
#include "experiments/data/match_file.h"
#include "experiments/data/match_folder.h"
#include "experiments/real/images/match_images.h"
#include "experiments/study/estimator_file.h"
#include "experiments/study/study_file.h"
#include "experiments/study/study_lock.h"
#include "tests/fuzz/bomb.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/gzip.h"
#include "tests/test_support/match_text.h"
#include "tests/test_support/peak_memory.h"
#include "tests/test_support/png.h"
#include "tests/test_support/small_study.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

class MatchFileBomb : public testing::Test {
 protected:
  testing::AssertionResult IsRefused(const std::string& bytes, const std::vector<std::string>& fragments) {
    constexpr double kMaxMb = 16.0;
    const std::string path = folder_.Write("bomb.csv", bytes);
    return IsRefusedWithin(
        kMaxMb, [&] { ReadMatchFile(path); }, fragments);
  }
  TempFolder folder_;
};

TEST_F(MatchFileBomb, OneHugeLine) {
  const std::string zero(1, '\0');
  for (const std::string& piece :
       std::vector<std::string>{",", " ", "\t", "x", "1,2,3,4,", "#", "x1,", zero}) {
    EXPECT_TRUE(IsRefused(MatchHeader() + Repeated(piece, (1 << 20) / piece.size()),
                          {"bomb.csv:5: the line is too long; at most 65536 bytes are allowed"}))
        << piece;
  }
}

TEST_F(MatchFileBomb, ManyColumns) {
  const std::string names = "x1,y1,x2,y2" + Repeated(",c", 1'000'000);
  EXPECT_TRUE(IsRefused(MatchHeader() + names, {"bomb.csv:5: the line is too long"}));
  EXPECT_TRUE(IsRefused(MatchHeader() + names.substr(0, 60'000),
                        {"bomb.csv:5: too many columns; at most 1000 are allowed"}));
  EXPECT_TRUE(
      IsRefused(MatchHeader() + "1,2,3,4" + Repeated(",", 997) + "\n", {"bomb.csv:5: too many columns"}));
  EXPECT_EQ(
      ReadMatchFile(folder_.Write("m.csv", MatchHeader() + "1,2,3,4" + Repeated(",", 996))).matches.size(),
      1u);
}

TEST_F(MatchFileBomb, BlankLinesAndCommentsTakeNoMemory) {
  for (const std::string line : {"\n", " \n", "#a:\n", "\r\n"}) {
    EXPECT_TRUE(IsRefused(Repeated(line, 1'000'000), {"size1", "is missing"})) << line;
  }
  std::string keys;
  for (int i = 0; i < 200'000; ++i) keys += fmt::format("# key{}: {}\n", i, i);
  EXPECT_TRUE(IsRefused(keys, {"size1", "is missing"}));
}

// 256 MiB of empty lines would take minutes.
TEST_F(MatchFileBomb, TooManyLines) {
  EXPECT_TRUE(IsRefused(Gzip(Repeated("\n", 2'000'001)),
                        {"bomb.csv:2000001: too many lines; at most 2000000 are allowed"}));
}

TEST_F(MatchFileBomb, GzipOfALongLineOrALongText) {
  EXPECT_TRUE(IsRefused(Gzip(std::string(64 << 20, ',')), {"bomb.csv:1: the line is too long"}));
  const std::string lines = Gzip(Repeated(std::string(999, ' ') + "\n", 16 << 10));  // 16 MiB in 64 kB
  EXPECT_TRUE(
      IsRefused(Repeated(lines, 17), {"the text is too long; at most 256 MiB, unpacked, are allowed"}));
}

TEST_F(MatchFileBomb, GzipWithinGzip) {
  EXPECT_TRUE(
      IsRefused(Gzip(Gzip(MatchHeader() + MatchRows(20))), {"bomb.csv: is packed twice (gzip within gzip)"}));
}

TEST_F(MatchFileBomb, MemoryIsThatOfTheMatches) {
  if (!CanMeasurePeakMemory()) GTEST_SKIP() << "memory cannot be measured here";
  const std::string path =
      folder_.Write("many.csv", MatchHeader() + Repeated("1,2,3,4" + std::string(200, ',') + "\n", 100'000));
  size_t num_matches = 0;
  EXPECT_LT(PeakMemoryMb([&] { num_matches = ReadMatchFile(path).matches.size(); }), 16.0);  // 20 MB of text
  EXPECT_EQ(num_matches, 100'000u);
}

TEST_F(MatchFileBomb, TooManyMatches) {
  const std::string path =
      folder_.Write("many.csv", MatchHeader() + Repeated("1,2,3,4\n", kMaxMatchesPerFile + 1));
  EXPECT_TRUE(IsRefusedWithin(120.0, [&] { ReadMatchFile(path); },
                              {"many.csv:1000005: too many matches; at most 1000000 are allowed"}));
}

TEST(IndexBomb, IsReadLineByLine) {
  const TempFolder folder;
  folder.Write("p.csv", MatchHeader() + MatchRows(10));
  std::string index = "pair_id,t_gt_weak\n";
  for (int i = 0; i < 200'000; ++i) index += fmt::format("a_pair_with_a_longer_name_{},1\n", i);
  folder.Write("INDEX.csv", index);
  if (!CanMeasurePeakMemory()) GTEST_SKIP() << "memory cannot be measured here";
  EXPECT_LT(PeakMemoryMb([&] { LoadMatchFolder({folder.path(), 0.5}); }), 16.0);
  folder.Write("INDEX.csv", Repeated(",", 1 << 20));
  EXPECT_TRUE(ThrowsInputError(
      [&] {
        LoadMatchFolder({folder.path(), 0.5});
      },
      {"INDEX.csv:1: the line is too long"}));
}

TEST(YamlBomb, IsRefused) {
  const std::string many = "at most 20000 are allowed";
  const std::vector<std::pair<std::string, std::string>> bombs = {
      {Repeated("[", 1 << 20), "deeper than 20 levels"},
      {Repeated("{a: ", 1 << 18), "deeper than 20 levels"},
      {Repeated("- ", 1 << 19), "deeper than 20 levels"},
      {Repeated("? ", 1 << 19), "deeper than 20 levels"},
      {"[" + Repeated("[],", 300'000) + "]", many},
      {"[" + Repeated(":,", 500'000) + "]", many},
      {"{" + Repeated("a,", 500'000) + "}", many},
      {Repeated("-\n", 1 << 19), many},
      {"a: &a [" + Repeated("x,", 1000) + "]\nb: [" + Repeated("*a,", 1000) + "]\n", many},
      {"a: &a " + std::string(9000, 'x') + "\nb: [" + Repeated("*a,", 1000) + "]\n", many},
      {"a: &a [*a]\n", "an alias (*) inside of what it stands for"},
      {"a: " + std::string(1 << 19, 'x'), "a value of 524288 bytes; at most 10000 are allowed"},
      {Repeated("---\n", 1 << 18), "more than one YAML document"},
      {Repeated("a", (1 << 20) + 1), "larger than a study can be (1 MiB)"},
  };
  for (const auto& [yaml, message] : bombs) {
    EXPECT_TRUE(IsRefusedWithin(300.0, [&] { ParseStudy(yaml, "bomb.yaml"); }, {"bomb.yaml:", message}))
        << yaml.substr(0, 40);
  }
}

TEST(YamlBomb, AliasesThatStandForLittleAreFine) {
  const Study study = ParseStudy(
      "data: {scene: uniform_volume}\n"
      "estimators:\n"
      "  - {name: rcme, label: a, options: &o {num_iterations: 20}}\n"
      "  - {name: rcme, label: b, options: *o}\n",
      "a.yaml");
  EXPECT_EQ(ReadOption(study.estimators.at(1), "num_iterations"), "20");
}

TEST(YamlBomb, TooManyCombinationsAreRefusedBeforeTheyAreBuilt) {
  std::string levels, factors;
  for (int i = 1; i <= 5000; ++i) levels += fmt::format("{},", i);
  for (const char* key : {"num_matches", "sigma_px", "max_depth_m"})
    factors += fmt::format("  {}: [{}]\n", key, levels);
  EXPECT_TRUE(IsRefusedWithin(
      100.0,
      [&] {
        ParseStudy("data: {scene: uniform_volume}\nestimators: [{name: rcme}]\nfactors:\n" + factors,
                   "bomb.yaml");
      },
      {"bomb.yaml:", "factors: more than 100000 combinations of levels"}));
}

TEST(LockBomb, IsRefused) {
  const auto lock_of = [](const std::string& text) {
    return ToYaml(StudyLock{"now", "rcme", Sha256(text), text});
  };
  const auto read = [](const std::string& yaml) {
    ReadWrittenPlan(ParseLock(yaml, "b.lock").text, "b.lock");
  };
  const std::vector<std::pair<std::string, std::string>> bombs = {
      {Repeated("#\n", (1 << 19) + 1), "is too long for a lock; at most 1048576 bytes are allowed"},
      {"program: " + Repeated("x", 1 << 19), "is no line of a lock"},
      {Repeated("\n", 1 << 19), "is no line of a lock"},
      {lock_of("a: &a [" + Repeated("x,", 1000) + "]\nb: [" + Repeated("*a,", 1000) + "]\n"),
       "at most 20000 are allowed"},
      {lock_of(Repeated("[", 1 << 18) + "\n"), "deeper than 20 levels"},
  };
  for (const auto& [yaml, message] : bombs) {
    EXPECT_TRUE(IsRefusedWithin(200.0, [&, &yaml = yaml] { read(yaml); }, {"b.lock:", message}))
        << yaml.substr(0, 40);
  }
}

class ImageBomb : public testing::Test {
 protected:
  testing::AssertionResult IsRefused(const std::string& bytes, const std::vector<std::string>& fragments) {
    constexpr double kMaxMb = 16.0;
    const std::string path = folder_.Write("image", bytes);
    return IsRefusedWithin(
        kMaxMb,
        [&] {
          MatchImages({path, path, {1.0, 1.0, 0.0, 0.0}, {}, {}, {}});
        },
        fragments);
  }
  TempFolder folder_;
};

TEST_F(ImageBomb, TheHeaderIsReadBeforeTheImage) {
  using namespace std::string_literals;
  const std::string too_many = "px are too many; at most 268435456 are read";
  std::string png = GreyPng(16, std::vector<std::uint8_t>(256));
  png.replace(16, 8, "\0\0\x40\0\0\0\x40\1"s);
  EXPECT_TRUE(IsRefused(png, {"image: 16384 x 16385 " + too_many}));
  EXPECT_TRUE(IsRefused("\xFF\xD8\xFF\xE0\0\4ab\xFF\xFF\xC2\0\x0B\x08\xFF\xDC\xFF\xDB\1\1\x11\0"s,
                        {"image: 65499 x 65500 " + too_many}));
  EXPECT_TRUE(IsRefused("BM" + std::string(12, '\0') + "\x28\0\0\0\0\0\1\0\0\0\xFF\xFF"s,  // 65536 x -65536
                        {"image: 65536 x 65536 " + too_many}));
  EXPECT_TRUE(
      IsRefused("BM" + std::string(12, '\0') + "\x0C\0\0\0\xFF\xFF\xFF\xFF"s, {"image: 65535 x 65535"}));
  for (const char type : {'1', '2', '3', '4', '5', '6'}) {
    EXPECT_TRUE(
        IsRefused(fmt::format("P{}\n# a 1 2\n65000 #\n 65000\n255\n", type), {"image: 65000 x 65000"}));
  }
  EXPECT_TRUE(IsRefused("II*\0\x08\0\0\0\2\0\0\1\4\0\1\0\0\0\0\0\1\0\1\1\3\0\1\0\0\0\xFF\xFF\0\0"s,
                        {"image: 65536 x 65535 " + too_many}));
  EXPECT_TRUE(IsRefused("MM\0*\0\0\0\x08\0\2\1\0\0\4\0\0\0\1\0\1\0\0\1\1\0\3\0\0\0\1\xFF\xFF\0\0"s,
                        {"image: 65536 x 65535 " + too_many}));
}

TEST_F(ImageBomb, OtherFormatsAndDamagedImages) {
  using namespace std::string_literals;
  for (const std::string& bytes :
       {""s, "x"s, "GIF89a"s, "P7\nWIDTH 1"s, "II+\0\x08\0\0\0"s, "RIFF....WEBP"s}) {
    EXPECT_TRUE(IsRefused(bytes, {"image: is not a PNG, JPEG, TIFF, BMP or PNM image"})) << bytes;
  }
  const std::string png = GreyPng(64, std::vector<std::uint8_t>(4096));
  for (const size_t size : {8u, 12u, 20u}) {
    EXPECT_TRUE(IsRefused(png.substr(0, size), {"image: the header of the PNG image is damaged"})) << size;
  }
  EXPECT_TRUE(IsRefused(png.substr(0, 24), {"image: the image is damaged"}));
  EXPECT_TRUE(IsRefused("\xFF\xD8\xFF\xD9", {"the header of the JPEG image is damaged"}));
  EXPECT_TRUE(IsRefused("P5 0 10 255\n", {"the header of the PNM image is damaged"}));
  EXPECT_TRUE(IsRefused("II*\0\x08\0\0\0"s, {"the header of the TIFF image is damaged"}));
  EXPECT_NO_THROW(
      MatchImages({folder_.Write("a", png), folder_.Write("b", png), {1.0, 1.0, 0.0, 0.0}, {}, {}, {}}));
}

// To open a pipe without a writer waits for ever, to read a device may never end.
TEST(SpecialFiles, AreRefused) {
  const TempFolder folder;
  const std::string pipe = folder.Path("pipe.csv");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const std::string message = pipe + ": is a pipe, not a";
  EXPECT_TRUE(ThrowsInputError([&] { ReadMatchFile(pipe); }, {message + " match file"}));
  EXPECT_TRUE(ThrowsInputError([&] { LoadMatchFolder({folder.path(), 0.5}); }, {message + " match file"}));
  EXPECT_TRUE(ThrowsInputError([&] { LoadStudy(pipe); }, {message + " study"}));
  EXPECT_TRUE(ThrowsInputError([&] { LoadEstimatorFile(pipe); }, {message + "n estimator file"}));
  EXPECT_TRUE(ThrowsInputError(
      [&] {
        MatchImages({pipe, pipe, {1.0, 1.0, 0.0, 0.0}, {}, {}, {}});
      },
      {message + "n image"}));
  EXPECT_TRUE(
      ThrowsInputError([] { ReadMatchFile("/dev/zero"); }, {"/dev/zero: is a device, not a match file"}));
  std::filesystem::remove(pipe);
  folder.Write("p.csv", MatchHeader() + MatchRows(10));
  ASSERT_EQ(mkfifo(folder.Path("INDEX.csv").c_str(), 0600), 0);
  EXPECT_TRUE(ThrowsInputError([&] { LoadMatchFolder({folder.path(), 0.5}); }, {"INDEX.csv: is a pipe"}));
}

TEST(ForeignNames, AreRefusedWhereTheyEnter) {
  const TempFolder folder;
  folder.Write("caf\xE9.csv", MatchHeader() + MatchRows(10));
  EXPECT_TRUE(ThrowsInputError(
      [&] {
        LoadMatchFolder({folder.path(), 0.5});
      },
      {"holds 'caf\\xE9.csv'; give the file a name of UTF-8 without control characters"}));
  EXPECT_TRUE(ThrowsInputError(
      [&] { ReadMatchFile(folder.Write("scene.csv", "# scene: \x1B[31m\n" + MatchHeader())); },
      {"scene.csv:1: scene: '\\x1B[31m' is not allowed; give UTF-8 without control characters"}));
  EXPECT_TRUE(ThrowsInputError(
      [&] {
        ReadMatchFile(folder.Write("scene.csv", "# scene: " + std::string(201, 'a') + "\n" + MatchHeader()));
      },
      {"scene.csv:1: scene: the name is too long; at most 200 bytes"}));
  const auto refuses = [](const std::string& entry, const std::string& message) {
    return ThrowsInputError(
        [&] { ParseStudy(entry + "\ndata: {scene: corridor}\nestimators: [{name: rcme}]\n", "a.yaml"); },
        {"a.yaml:1: " + message});
  };
  EXPECT_TRUE(
      refuses("name: \"a\\eb\"", "name: 'a\\x1Bb' is not allowed; give text without control characters"));
  EXPECT_TRUE(refuses("name: \"a\\0b\"", "name: 'a\\x00b' is not allowed"));
  EXPECT_TRUE(refuses("name: " + std::string(201, 'a'), "name: 'aaa"));
}

}  // namespace
}  // namespace rcme
