// From real pairs to studies that resemble them, which the program can run.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/data/match_file.h"
#include "tests/end_to_end/bad_input.h"
#include "tests/test_support/match_text.h"

namespace rcme {
namespace {

class TwinProgram : public testing::Test {
 protected:
  TwinProgram() {
    for (const char* name : {"a_1", "a_2", "b_1"}) {
      const std::string scene = std::string("# scene: ").append(1, name[0]) + "\n";
      pairs_.Write(std::string(name) + ".csv",
                   scene + MatchHeader() + TruePoseHeader() + NoisyRows(static_cast<std::uint64_t>(name[2])));
    }
  }
  // 120 right matches with noise of about 0.2 px and 20 wrong ones, seen through a lens of this k1.
  static std::string NoisyRows(std::uint64_t seed, double k1 = 0.0) {
    RandomStream rng({.seed = seed, .purpose = 77});
    std::string rows;
    for (int i = 0; i < 140; ++i) {
      const double depth = rng.Uniform(4.0, 12.0), x = rng.Uniform(100.0, 500.0),
                   y = rng.Uniform(100.0, 350.0);
      double x2 = x + 600.0 * 0.8 / depth + 0.3 * rng.Normal(),
             y2 = y + 600.0 * 0.6 / depth + 0.3 * rng.Normal();
      if (i % 7 == 0) x2 = rng.Uniform(0.0, 640.0), y2 = rng.Uniform(0.0, 480.0);
      rows += fmt::format("{},{}\n", Distort(x, y, k1), Distort(x2, y2, k1));
    }
    return rows;
  }

  static std::string Distort(double x, double y, double k1) {
    const double u = (x - 319.5) / 600.0, v = (y - 239.5) / 600.0, factor = 1.0 + k1 * (u * u + v * v);
    return fmt::format("{},{}", 319.5 + 600.0 * factor * u, 239.5 + 600.0 * factor * v);
  }

  TempFolder pairs_, folder_;
};

TEST_F(TwinProgram, WritesStudiesThatRun) {
  const std::string out = folder_.Path("twins");
  const ProgramResult result = RunRcme({"twin", pairs_.path(), "--out", out, "--twins", "2"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, ReadBytes(out + "/twin.txt"));
  for (const char* part :
       {"a: 2 pairs, 2 with a geometry", "b: 1 pairs", "spatial_halves", "within: semi-real"})
    EXPECT_NE(result.out.find(part), std::string::npos) << part << " is not in\n" << result.out;
  EXPECT_NE(ReadBytes(out + "/twin.csv").find("\na,2,semi_real,refusal,rate,no,0,0,"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(out + "/a_pairs/a_1.csv"));
  for (const char* study : {"/a.yaml", "/a_simulated.yaml"}) {
    const std::string run = folder_.Path("run.sqlite");
    std::filesystem::remove(run);
    const ProgramResult ran = RunRcme({"run", out + study, "--trials", "2", "--out", run});
    ASSERT_EQ(ran.exit_code, 0) << study << ran.err;
    EXPECT_NE(RunRcme({"summarize", run}).out.find("rcme_calibrated"), std::string::npos);
  }
  EXPECT_NE(ReadBytes(out + "/a.yaml").find("redraw_noise_px"), std::string::npos);
  const std::string once = ReadBytes(out + "/twin.csv");
  const ProgramResult again =
      RunRcme({"twin", pairs_.path(), "--out", out, "--twins", "2", "--format", "json"});
  ASSERT_EQ(again.exit_code, 0);
  EXPECT_EQ(again.out, ReadBytes(out + "/twin.json"));
  const auto json = nlohmann::json::parse(again.out);
  EXPECT_EQ(json["format"], "rcme twin 1");
  EXPECT_EQ(json["scenes"][0]["name"], "a");
  EXPECT_EQ(json["scenes"][0]["semi_real"]["scene"], "match_files");
  EXPECT_EQ(json["scenes"][0]["comparisons"][0]["quantity"], "refusal");
  EXPECT_EQ(json["scenes"][0]["comparisons"][0]["fitted"], false);
  EXPECT_EQ(ReadBytes(out + "/twin.csv"), once);
}

TEST_F(TwinProgram, OfOneSceneWritesOneStudy) {
  const std::string study = folder_.Path("b.yaml");
  const ProgramResult result =
      RunRcme({"twin", pairs_.path(), "--scene", "b", "--out", study, "--twins", "1"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(std::filesystem::exists(study));
  EXPECT_TRUE(std::filesystem::exists(folder_.Path("b_pairs")));
}

// Twins are of undistorted matches, which have more noise than those of the images.
TEST_F(TwinProgram, OfALensAssumesTheNoiseOfUndistortedMatches) {
  TempFolder lens;
  const std::string camera = ": SIMPLE_RADIAL 640 480 600 319.5 239.5 -0.4\n", out = folder_.Path("twins");
  const std::string pair =
      lens.Write("a.csv", "# scene: a\n# sigma_px: 0.4\n# camera1" + camera + "# camera2" + camera +
                              TruePoseHeader() + NoisyRows(1, -0.4));
  const auto answer = nlohmann::json::parse(RunRcme({"estimate", pair, "--format", "json"}).out);
  EXPECT_EQ(answer["evidence"]["sigma_assumed_px"], 0.4) << "an estimate speaks of the images";
  ASSERT_EQ(RunRcme({"twin", lens.path(), "--out", out, "--twins", "1"}).exit_code, 0);
  const MotionProblem problem = MakeMotionProblem(ReadMatchFile(pair), {});
  EXPECT_GT(problem.sigma_px, 0.41);
  for (const char* line : {"/a.yaml sigma_px: ", "/a_simulated.yaml assumed_sigma_px: "}) {
    const std::string words = line, name = words.substr(0, words.find(' ')), key = words.substr(name.size());
    EXPECT_NE(ReadBytes(out + name).find(fmt::format("{}{:.4g}", key, problem.sigma_px)), std::string::npos)
        << ReadBytes(out + name);
  }
}

// The time is over before the second pair; other options are other twins.
TEST_F(TwinProgram, GoesOnAfterATimeLimit) {
  const std::string study = folder_.Path("b.yaml"), kept = study + ".unfinished.part";
  const std::vector<std::string> call = {"twin", pairs_.path(), "--scene", "b", "--out", study};
  const auto with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all = call;
    all.insert(all.end(), more.begin(), more.end());
    return RunRcme(all);
  };
  const ProgramResult result = with({"--twins", "1", "--max-time", "0.001s"});
  EXPECT_EQ(result.exit_code, 75) << result.err;
  EXPECT_TRUE(result.err.find(kept + " has 0 steps, the same command goes on") != std::string::npos ||
              result.err.find(kept + " has 1 steps, the same command goes on") != std::string::npos)
      << result.err;
  EXPECT_TRUE(IsRefused(with({"--twins", "2"}), {kept, "twins: 1", "--out"}));
  ASSERT_EQ(with({"--twins", "1"}).exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(kept));
}

// A match file of somebody's may call its scene what it likes.
TEST_F(TwinProgram, WritesNothingOutsideItsFolder) {
  TempFolder theirs;
  const std::string out = folder_.Path("twins");
  theirs.Write("a.csv", "# scene: ../escaped\n" + MatchHeader() + TruePoseHeader() + NoisyRows(1));
  theirs.Write("b.csv", "# scene: " + folder_.Path("absolute") + "\n" + MatchHeader() + TruePoseHeader() +
                            NoisyRows(2));
  const ProgramResult result = RunRcme({"twin", theirs.path(), "--out", out, "--twins", "1"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(std::filesystem::exists(out + "/_.._escaped.yaml"));
  size_t num_entries = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) num_entries += entry.exists();
  EXPECT_EQ(num_entries, 1u) << "something lies beside " << out;
  theirs.Write("b.csv", "# scene: .. escaped\n" + MatchHeader() + TruePoseHeader() + NoisyRows(2));
  EXPECT_TRUE(
      IsRefused(RunRcme({"twin", theirs.path(), "--out", out, "--twins", "1"}), {"scene", "another scene"}));
}

TEST_F(TwinProgram, SaysWhatIsWrong) {
  const auto call = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"twin", pairs_.path(), "--twins", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunRcme(arguments);
  };
  EXPECT_TRUE(IsRefused(call({"--out", folder_.Path("s.yaml")}), {"--out", "one scene's study", "a, b"}));
  EXPECT_TRUE(
      IsRefused(call({"--out", folder_.Path("x"), "--scene", "c"}), {"--scene: there is no scene 'c'"}));
  EXPECT_TRUE(IsRefused(RunRcme({"twin", folder_.Path("none"), "--out", folder_.Path("x")}), {"none"}));
  TempFolder few;
  few.Write("a.csv", "# scene: a\n" + MatchHeader() + MatchRows(5));
  EXPECT_TRUE(IsRefused(RunRcme({"twin", few.path(), "--out", folder_.Path("x")}),
                        {"scene a", "nothing to resemble"}));
}

}  // namespace
}  // namespace rcme
