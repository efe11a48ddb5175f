// Files of learned features as NumPy writes them, and what damage does to them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "experiments/real/sequences/listed_pairs.h"
#include "experiments/real/sequences/make_pairs.h"
#include "experiments/real/sequences/npz_file.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/paths.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

// Runs Python with `np` and a function `save(name, **arrays)` into `folder`.
void RunNumpy(const TempFolder& folder, const std::string& code) {
  const std::string script = folder.Write(
      "script.py", "import os, numpy as np\nos.chdir('" + folder.path() +
                       "')\n"
                       "def save(name, how=np.savez, **arrays): os.makedirs(os.path.dirname(name) or '.', "
                       "exist_ok=True); how(name + '.npz', **arrays)\n"
                       "p0 = np.array([[10, 20.5], [30, 40], [50, 60]], dtype='<f4')\n"
                       "p1 = np.array([[11, 21], [31.25, 41]], dtype='<f4')\n" +
                       code);
  const std::string command = "\"$('" + SourceFolder() + "/scripts/find-python')\" '" + script + "'";
  ASSERT_EQ(std::system(command.c_str()), 0) << code;
}

DatasetOptions MakeNpzOptions(const std::string& folder) {
  DatasetOptions options;
  options.folder = folder;
  options.name = "hall";
  options.K = {500, 510, 320, 240};
  return options;
}

MatchFile ReadOnly(const std::string& folder) {
  const auto pairs = OpenNpzPairs(MakeNpzOptions(folder));
  EXPECT_EQ(pairs->size(), 1u);
  return pairs->Read(0).file;
}

void ExpectMatches(const MatchFile& file) {
  ASSERT_EQ(file.matches.size(), 2u);
  EXPECT_EQ(file.matches[0].x1_px, Eigen::Vector2d(10, 20.5));
  EXPECT_EQ(file.matches[0].x2_px, Eigen::Vector2d(31.25, 41));
  EXPECT_EQ(file.matches[1].x1_px, Eigen::Vector2d(50, 60));
  EXPECT_EQ(file.matches[1].x2_px, Eigen::Vector2d(11, 21));
  EXPECT_EQ(file.better_score, BetterScore::kHigher);
  EXPECT_EQ(file.scores, (std::vector<double>{0.5, 0.75}));
}

constexpr const char* kByPoint = "m = np.array([1, -1, 0])\nc = np.array([.5, 0, .75], dtype='<f4')\n";

TEST(OpenNpzPairs, ReadsWhatNumpyWritesInEveryForm) {
  const TempFolder folder;
  std::string code = kByPoint;
  std::vector<std::string> calls;
  for (const char* how : {"np.savez", "np.savez_compressed"}) {
    for (const char* arrays :
         {"matches=m, match_confidence=c", "matches=m.astype('<i4'), matching_scores=c.astype('<f2')",
          "matches0=m, matching_scores0=c.astype('<f8')",
          "matches=np.array([[0, 1], [2, 0]]), scores=np.array([.5, .75]), matches0=m"}) {
      calls.push_back("save('" + std::to_string(calls.size()) + "/a_b', " + how +
                      ", keypoints0=p0, keypoints1=p1, " + arrays + ")\n");
      code += calls.back();
    }
  }
  RunNumpy(folder, code);
  for (size_t i = 0; i < calls.size(); ++i) {
    SCOPED_TRACE(calls[i]);
    const std::string path = folder.Path(std::to_string(i));
    const MatchFile file = ReadOnly(path);
    ExpectMatches(file);
    EXPECT_EQ(file.scene, "hall");
    EXPECT_EQ(file.camera2.fy, 510);
    EXPECT_EQ(file.camera1.width, 641);
    EXPECT_EQ(OpenNpzPairs(MakeNpzOptions(path))->PairId(0), "a_b");
  }
}

TEST(OpenNpzPairs, NeedsNoScoresAndKeepsThoseOfMatchesThatALensShows) {
  const TempFolder folder;
  RunNumpy(folder, std::string(kByPoint) + "save('a', keypoints0=p0, keypoints1=p1, matches=m)\n");
  EXPECT_FALSE(ReadOnly(folder.path()).better_score.has_value());
  const TempFolder distorted;
  RunNumpy(distorted,
           std::string(kByPoint) +
               "p0[0] = 9e5\nsave('a', keypoints0=p0, keypoints1=p1, matches=m, match_confidence=c)\n");
  DatasetOptions options = MakeNpzOptions(distorted.path());
  options.lens = LensModel::kRadtan;
  options.distortion = {-0.2, 0, 0, 0};
  const MatchFile file = OpenNpzPairs(options)->Read(0).file;
  ASSERT_EQ(file.matches.size(), 1u);
  EXPECT_EQ(file.scores, std::vector<double>{0.75});
  const auto x1_px = Undistort(MakeLens({500, 510, 320, 240, 0, 0}, options.lens, options.distortion, "lens"),
                               Eigen::Vector2d(50, 60));
  ASSERT_TRUE(x1_px.has_value());
  EXPECT_NEAR((file.matches[0].x1_px - *x1_px).norm(), 0.0, 1e-9);
}

// The scores go into the match file.
TEST(OpenNpzPairs, EndsInMatchFiles) {
  const TempFolder folder, out;
  RunNumpy(folder, std::string(kByPoint) +
                       "save('a', keypoints0=p0, keypoints1=p1, matches=m, match_confidence=c)\n");
  PairsOptions options;
  options.out = out.Path("pairs");
  options.gate.criterion.reset();
  PairJournal journal(options.out, "test");
  MakeListedPairs(*OpenNpzPairs(MakeNpzOptions(folder.path())), options, &journal);
  ExpectMatches(ReadMatchFile(options.out + "/a.csv"));
}

TEST(OpenNpzPairs, RefusesWhatIsWrongInASentenceThatNamesTheArray) {
  struct Case {
    const char* arrays;
    std::vector<std::string> fragments;
  };
  const std::vector<Case> cases = {
      {"matches=m + 1", {"a.npz: array 'matches': row 0 is of key point 2; the image has 2"}},
      {"matches=m - 1", {"'matches': row 1 is of key point -2"}},
      {"matches=np.array([[0, -1]])", {"'matches': row 0 is of key point -1"}},
      {"matches=np.array([[3, 0]])", {"'matches': row 0 is of key point 3; the image has 3"}},
      {"matches=m[:2]", {"'matches': is of shape [2]", "[3], one for each row of keypoints0, or [m, 2]"}},
      {"matches=m[None]", {"'matches': is of shape [1, 3]"}},
      {"matches=c", {"'matches'", "whole numbers (i4, i8)"}},
      {"other=m", {"array 'matches': is missing; the file has 'keypoints0', 'keypoints1', 'other'"}},
      {"matches=m, scores=c[:2]", {"'scores': is of shape [2]; [3] is needed"}},
      {"matches=m, scores=c * np.nan", {"'scores': row 0 is nan"}},
      {"matches=m.astype('>i8')",
       {"'matches': its numbers are of type '>i8'; little-endian f2, f4, f8, i4 and i8"}},
      {"matches=m.astype('u1')", {"'|u1'"}},
      {"matches=np.array([{}], dtype=object)", {"'|O'"}},
      {"matches=np.zeros(3, dtype=[('a', '<i4')])", {"'matches': has named columns"}},
      {"matches=np.asfortranarray(np.zeros((3, 2), dtype=int))", {"is in Fortran order; save numpy.asc"}},
      {"matches=np.zeros((1,) * 9, dtype=int)", {"8 dimensions are allowed"}},
      {"matches=np.zeros(10**7, dtype=int)", {"unpacks to 80000128 bytes; 64 MiB are allowed"}},
      {"keypoints0=p0 * np.nan, matches=m",
       {"a.npz: array 'keypoints0': key point 0 is (nan, nan); finite numbers in"}},
      {"keypoints0=p0 * 1e6, matches=m", {"a.npz: array 'keypoints0': key point 0 is"}},
      {"keypoints0=p0[None], matches=m", {"a.npz: array 'keypoints0': is of shape [1, 3, 2]; [n, 2]"}},
      {"keypoints0=p0.T.copy(), matches=m", {"a.npz: array 'keypoints0': is of shape [2, 3]; [n, 2]"}},
  };
  const TempFolder folder;
  std::string code = std::string(kByPoint) +
                     "def wrong(name, keypoints0=p0, **arrays):\n"
                     "  save(name, np.savez_compressed, keypoints0=keypoints0, keypoints1=p1, **arrays)\n";
  for (size_t i = 0; i < cases.size(); ++i)
    code += "wrong('" + std::to_string(i) + "/a', " + cases[i].arrays + ")\n";
  RunNumpy(folder, code);
  for (size_t i = 0; i < cases.size(); ++i)
    EXPECT_TRUE(ThrowsInputError([&] { ReadOnly(folder.Path(std::to_string(i))); }, cases[i].fragments))
        << cases[i].arrays;
}

TEST(OpenNpzPairs, NeedsAFolderWithFilesAndK) {
  const TempFolder folder;
  DatasetOptions options = MakeNpzOptions(folder.path());
  EXPECT_TRUE(ThrowsInputError([&] { OpenNpzPairs(options); }, {folder.path(), "holds no *.npz"}));
  options.K.clear();
  EXPECT_TRUE(ThrowsInputError([&] { OpenNpzPairs(options); }, {"--K: fx fy cx cy", "is needed"}));
  options.folder = folder.Path("none");
  EXPECT_TRUE(ThrowsInputError([&] { OpenNpzPairs(options); }, {"none: is not there"}));
}

// Every number of the five types, as NumPy has it; version 2 of the header.
TEST(NpzFile, ReadsNumbersAsNumpyDoes) {
  const TempFolder folder;
  RunNumpy(
      folder,
      "h = np.array([0, 1, -2.5, 65504, 6e-8, 6.1e-5, np.inf], dtype='<f2')\n"
      "with open('two.npy', 'wb') as f: np.lib.format.write_array(f, p0, version=(2, 0))\n"
      "save('a', h=h, same=h.astype('<f8'), f4=np.array(1.1, dtype='<f4'), i4=np.array([-2**31, 7], '<i4'),"
      " i8=np.array([[-2**62, 7]]), none=np.zeros((0, 2)))\n");
  const NpzFile file(folder.Path("a.npz"));
  EXPECT_EQ(file.Read("h").values, file.Read("same").values);
  EXPECT_FALSE(file.Read("h").is_whole);
  EXPECT_EQ(file.Read("f4").values, std::vector<double>{1.1f});
  EXPECT_TRUE(file.Read("f4").shape.empty());
  EXPECT_EQ(file.Read("i4").values, (std::vector<double>{-2147483648.0, 7}));
  EXPECT_EQ(file.Read("i8").values, (std::vector<double>{-std::ldexp(1.0, 62), 7}));
  EXPECT_TRUE(file.Read("i8").is_whole);
  EXPECT_EQ(file.Read("none").shape, (std::vector<size_t>{0, 2}));
  EXPECT_EQ(ParseNpy(ReadBytes(folder.Path("two.npy")), "two").values,
            (std::vector<double>{10, 20.5, 30, 40, 50, 60}));
}

// A .npy of version 1 that lies about its shape.
TEST(ParseNpy, RefusesShapesThatTheBytesAreNotOf) {
  const auto npy = [](const std::string& shape) {
    const std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': " + shape + ", }\n";
    return std::string("\x93NUMPY\x01\x00", 8) + static_cast<char>(header.size()) + '\0' + header +
           std::string(16, '\0');
  };
  EXPECT_EQ(ParseNpy(npy("(2,)"), "x").values, (std::vector<double>{0, 0}));
  for (const char* shape : {"(3,)", "(1,)", "()", "(0,)", "(4294967296, 4294967296, 2)",
                            "(999999999999999999, 2)", "(0, 999999999999999999)"})
    EXPECT_TRUE(ThrowsInputError([&] { ParseNpy(npy(shape), "x"); }, {"x: its shape [", "16 bytes of <f8"}))
        << shape;
  for (const char* shape :
       {"(-2,)", "(2", "2", "(2.0,)", "(9999999999999999999999,)", "(2,) 'x'", "(2,), 'a': 1"})
    EXPECT_TRUE(ThrowsInputError([&] { ParseNpy(npy(shape), "x"); }, {"x: its header is damaged"})) << shape;
}

// Damage: the same arrays, or an InputError that names the file.
class DamagedNpz : public testing::TestWithParam<const char*> {};

TEST_P(DamagedNpz, GivesTheSameArraysOrAnInputError) {
  const TempFolder folder;
  RunNumpy(folder, std::string(kByPoint) + "save('a', " + GetParam() +
                       ", keypoints0=p0, keypoints1=p1, matches=m, match_confidence=c)\n");
  const std::string bytes = ReadBytes(folder.Path("a.npz"));
  size_t num_refused = 0;
  const auto expect_same_or_refused = [&](const std::string& damaged) {
    folder.Write("a.npz", damaged);
    try {
      ExpectMatches(ReadOnly(folder.path()));
    } catch (const InputError& error) {
      ++num_refused;
      EXPECT_EQ(std::string(error.what()).find(folder.Path("a.npz")), 0u) << error.what();
    }
  };
  for (size_t length = 0; length < bytes.size(); ++length) expect_same_or_refused(bytes.substr(0, length));
  EXPECT_EQ(num_refused, bytes.size());
  for (const int flip : {0xff, 0x01, 0x80}) {
    for (size_t i = 0; i < bytes.size(); ++i) {
      std::string damaged = bytes;
      damaged[i] = static_cast<char>(damaged[i] ^ flip);
      SCOPED_TRACE(i);
      expect_same_or_refused(damaged);
    }
  }
  EXPECT_GT(num_refused, 2 * bytes.size());
}

INSTANTIATE_TEST_SUITE_P(Npz, DamagedNpz, testing::Values("np.savez", "np.savez_compressed"));

}  // namespace
}  // namespace rcme
