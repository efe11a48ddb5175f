// From rendered data sets to studies and to what is said of them, through the program.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/end_to_end/bad_input.h"
#include "tests/test_support/rendered_sequence.h"
#include "tests/test_support/result_formats.h"

namespace rcme {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStudyOfPairs =
    "name: pairs\nseed: 1\ntrials: 1\ndata: {scene: match_files, folder: FOLDER, sigma_px: 0.5}\n"
    "estimators: [{name: rcme_calibrated}]\n";

TEST(PairsProgram, FromKittiToARateAndToAValidation) {
  const TempFolder folder;
  const std::string dataset = folder.Path("dataset"), out = folder.Path("pairs");
  WriteKittiSequence(dataset, "04", 7);
  const std::vector<std::string> command = {"pairs",        dataset, "--layout", "kitti",
                                            "--neighbours", "2",     "--out",    out};
  const ProgramResult made = RunRcme(command);
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(made.out, ReadBytes(out + "/pairs.txt"));
  EXPECT_NE(made.out.find("kitti_04"), std::string::npos) << made.out;
  EXPECT_NE(ReadBytes(out + "/INDEX.csv").find("image_0/000000.png"), std::string::npos);
  // Again: nothing is left to be done.
  const std::string journal = ReadBytes(out + "/pairs.journal");
  const ProgramResult again = RunRcme(command);
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_NE(again.err.find("continues after"), std::string::npos) << again.err;
  EXPECT_EQ(again.out, made.out);
  ExpectFormatsAgree(command);
  EXPECT_EQ(ReadBytes(out + "/pairs.journal"), journal);
  std::vector<std::string> other = command;
  other.insert(other.end(), {"--detector", "orb"});
  EXPECT_TRUE(IsRefused(RunRcme(other), {"--out: " + out, "other options"}));

  std::string study = kStudyOfPairs;
  study.replace(study.find("FOLDER"), 6, out);
  const std::string yaml = folder.Write("study.yaml", study), run = folder.Path("run.sqlite");
  ASSERT_EQ(RunRcme({"run", yaml, "--out", run, "--threads", "1"}).exit_code, 0);
  const ProgramResult summary = RunRcme({"summarize", run});
  EXPECT_EQ(summary.exit_code, 0) << summary.err;
  EXPECT_NE(summary.out.find("kitti_04"), std::string::npos) << summary.out;
  const ProgramResult validated =
      RunRcme({"validate", out, "--out", folder.Path("validation"), "--no-figure", "--twins", "1"});
  EXPECT_EQ(validated.exit_code, 0) << validated.err;
  EXPECT_EQ(validated.out.find(" 0 loops"), std::string::npos) << validated.out;
}

// Without a pair there is nothing for a study to read: exit code 2, and how many were dropped for which
// reason.
TEST(PairsProgram, EndsWithTwoAndTheReasonsWhereNoPairIsKept) {
  const TempFolder folder;
  const std::string dataset = folder.Path("dataset");
  WriteKittiSequence(dataset, "04", 3);
  const std::vector<std::string> strict = {"pairs", dataset,           "--layout",
                                           "kitti", "--least-matches", "100000"};
  std::vector<std::string> command = strict;
  command.insert(command.end(), {"--out", folder.Path("strict")});
  EXPECT_TRUE(IsRefused(RunRcme(command),
                        {"no pair was kept: of 2 pairs 2 too_few_matches", "INDEX.csv lists them"}));
  EXPECT_TRUE(fs::exists(folder.Path("strict") + "/INDEX.csv"));
  for (const char* image : {"000000", "000001", "000002"})
    fs::resize_file(dataset + "/sequences/04/image_0/" + image + ".png", 5000);
  command = strict;
  command.insert(command.end(), {"--out", folder.Path("damaged")});
  EXPECT_TRUE(
      IsRefused(RunRcme(command), {"no pair was kept: none could be made; 3 images were skipped, the first: ",
                                   "000000.png: the image is damaged: it ends early"}));
}

// Every image with each of the two before it, which makes loops; scores are written, and what is recommended
// is for pairs without truth.
TEST(PairsProgram, PairsAllImagesOfAWindowAndRecommendsWhatNeedsNoTruth) {
  const TempFolder folder;
  const std::string images = folder.Path("images"), out = folder.Path("out");
  WriteImageFolder(images, 4, RenderedCamera());
  const std::vector<std::string> command = {"pairs", images,     "--layout", "images", "--gate", "off",
                                            "--K",   "260",      "262",      "158.3",  "121.6",  "--window",
                                            "2",     "--scores", "--ratio",  "1",      "--out",  out};
  const ProgramResult made = RunRcme(command);
  ASSERT_EQ(made.exit_code, 0) << made.err;
  for (const char* pair :
       {"000000_000001", "000000_000002", "000001_000002", "000001_000003", "000002_000003"})
    EXPECT_TRUE(fs::exists(out + "/images_" + pair + ".csv")) << pair;
  EXPECT_FALSE(fs::exists(out + "/images_000000_000003.csv"));
  const std::string pair = out + "/images_000000_000001.csv";
  EXPECT_NE(made.err.find("next: rcme estimate " + pair + " (one motion), or rcme validate " + out),
            std::string::npos)
      << made.err;
  EXPECT_EQ(made.err.find("rcme run"), std::string::npos) << made.err;
  EXPECT_NE(ReadBytes(pair).find("# better_score: lower\nx1,y1,x2,y2,sigma_px,score\n"), std::string::npos);
  EXPECT_EQ(RunRcme({"estimate", pair}).exit_code, 0);
  const ProgramResult again = RunRcme(command);
  EXPECT_NE(again.err.find("continues after 5 pairs"), std::string::npos) << again.err;
  std::vector<std::string> both = command;
  both.insert(both.end(), {"--neighbours", "2"});
  EXPECT_TRUE(IsRefused(RunRcme(both), {"--neighbours: does not apply with --window"}));
}

// Half of K: a warning that says so, once for all pairs.
TEST(PairsProgram, WarnsWhereKIsNotOfTheImages) {
  const TempFolder folder;
  const std::string images = folder.Path("images"), out = folder.Path("out");
  WriteImageFolder(images, 3, RenderedCamera());
  const ProgramResult half = RunRcme({"pairs", images, "--layout", "images", "--gate", "off", "--out", out,
                                      "--K", "130", "131", "78.9", "60.5"});
  EXPECT_EQ(half.exit_code, 0) << half.err;
  EXPECT_NE(
      half.err.find("warning: images: K: the principal point is the centre of an image of 161 x 121 px"),
      std::string::npos)
      << half.err;
  const ProgramResult estimated = RunRcme({"estimate", out, "--format=jsonl"});
  EXPECT_NE(estimated.err.find("(and 1 more): the principal point is the centre of an image of"),
            std::string::npos)
      << estimated.err;
  EXPECT_NE(estimated.out.find("\"warnings\":[\"" + out), std::string::npos) << estimated.out;
  EXPECT_TRUE(IsRefused(RunRcme({"pairs", images, "--layout", "images", "--out", folder.Path("other"), "--K",
                                 "158.3", "121.6", "260", "262"}),
                        {"images: K: 158.3 121.6 260 262", "the numbers look like cx cy fx fy"}));
}

TEST(PairsProgram, EndsWithTwoAndThePathWhereSomethingIsWrong) {
  const TempFolder folder;
  const std::string dataset = folder.Path("dataset"), out = folder.Path("out");
  WriteKittiSequence(dataset, "04", 3);
  const auto pairs = [&](const std::vector<std::string>& more) {
    std::vector<std::string> command = {"pairs", dataset, "--out", out};
    command.insert(command.end(), more.begin(), more.end());
    return RunRcme(command);
  };
  EXPECT_TRUE(IsRefused(pairs({}), {"--layout"}));
  EXPECT_TRUE(IsRefused(pairs({"--layout", "hpatches"}), {"--layout"}));
  EXPECT_TRUE(IsRefused(pairs({"--layout", "kiti"}), {"'kiti'", "did you mean 'kitti'?"}));
  EXPECT_TRUE(IsRefused(pairs({"--layout", "kitti", "--gate", "orbslam2"}), {"did you mean 'orb_slam2'?"}));
  EXPECT_TRUE(IsRefused(pairs({"--layout", "images", "--lens", "fisheyes"}), {"did you mean 'fisheye'?"}));
  EXPECT_TRUE(IsRefused(pairs({"--layout", "euroc"}), {dataset + "/mav0: is not there"}));
  EXPECT_TRUE(IsRefused(pairs({"--layout", "tum"}), {dataset + "/rgb.txt: is not there"}));
  EXPECT_TRUE(IsRefused(pairs({"--layout", "colmap"}), {dataset + "/database.db: is not there"}));
  EXPECT_TRUE(IsRefused(pairs({"--layout", "matches"}), {"holds no *.csv"}));
  EXPECT_TRUE(IsRefused(pairs({"--layout", "images"}), {"--K: fx fy cx cy"}));
  EXPECT_TRUE(IsRefused(pairs({"--layout", "npz"}), {"--K: fx fy cx cy", "only key points and matches"}));
  EXPECT_TRUE(IsRefused(pairs({"--layout", "npz", "--K", "500", "500", "320", "240"}),
                        {dataset + ": holds no *.npz"}));
  EXPECT_TRUE(
      IsRefused(pairs({"--layout", "npz", "--every", "2"}), {"--every: does not apply to the layout npz"}));
  EXPECT_TRUE(IsRefused(pairs({"--layout", "kitti", "--K", "1", "1", "0", "0"}),
                        {"--K: does not apply to the layout kitti"}));
  EXPECT_TRUE(IsRefused(pairs({"--layout", "kitti", "--detector", "surf"}), {"--detector", "surf"}));
  EXPECT_TRUE(IsRefused(pairs({"--layout", "kitti", "--gate", "hope"}), {"--gate", "hope"}));
  EXPECT_TRUE(IsRefused(RunRcme({"pairs", dataset, "--layout", "kitti", "--out", dataset}),
                        {"is the data set itself"}));
  EXPECT_TRUE(IsRefused(RunRcme({"pairs", "/nowhere", "--layout", "kitti", "--out", out}),
                        {"/nowhere: is not there"}));
  fs::remove(dataset + "/sequences/04/image_0/000001.png");
  EXPECT_TRUE(
      IsRefused(pairs({"--layout", "kitti"}), {dataset + "/sequences/04/image_0/000001.png: is not there"}));
  EXPECT_FALSE(fs::exists(out));
}

}  // namespace
}  // namespace rcme
