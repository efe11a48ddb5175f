// Thousands of damaged studies, estimator files, match files and images: each is read or refused with an
// InputError whose message is plain text on one line. Anything else (another exception, a crash, a
// sanitizer's complaint, minutes) fails. The harnesses in tests/fuzz/harness go on where this ends.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <sstream>

#include "experiments/data/camera_noise.h"
#include "experiments/data/match_file.h"
#include "experiments/real/images/image_header.h"
#include "experiments/study/estimator_file.h"
#include "experiments/study/study_file.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"
#include "tests/fuzz/harness/colmap_tables.h"
#include "tests/fuzz/harness/dataset_inputs.h"
#include "tests/test_support/gzip.h"
#include "tests/test_support/match_text.h"
#include "tests/test_support/mutated.h"
#include "tests/test_support/paths.h"
#include "tests/test_support/small_study.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

constexpr std::uint64_t kSeed = 1;

// The inputs of a folder of this project.
std::vector<std::string> Corpus(const std::string& folder) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(SourceFolder() + "/" + folder)) {
    if (entry.is_regular_file()) paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> inputs;
  for (const std::filesystem::path& path : paths) inputs.push_back(ReadBytes(path.string()));
  return inputs;
}

struct Outcomes {
  int num_read = 0, num_refused = 0;
};

template <typename Action>
void Count(Action action, const std::string& input, Outcomes* outcomes) {
  try {
    action();
    ++outcomes->num_read;
  } catch (const InputError& error) {
    ++outcomes->num_refused;
    EXPECT_FALSE(std::string(error.what()).empty());
  } catch (const std::exception& error) {
    ADD_FAILURE() << "not an InputError: " << error.what() << "\n of " << Printable(input, 10'000);
  }
}

// Reads every input as it is and `num_mutants` damaged ones.
template <typename Read>
Outcomes ReadDamaged(const std::vector<std::string>& corpus, const std::vector<std::string>& words,
                     int num_mutants, Read read) {
  Outcomes outcomes;
  for (const std::string& input : corpus) Count([&] { read(input); }, input, &outcomes);
  RandomStream rng({.seed = kSeed, .purpose = 78});
  for (int i = 0; i < num_mutants; ++i) {
    const std::string input = Mutated(corpus[static_cast<size_t>(i) % corpus.size()], words, rng);
    Count([&] { read(input); }, input, &outcomes);
  }
  return outcomes;
}

const std::vector<std::string>& YamlWords() {
  static const std::vector<std::string> words = {
      "[",
      "]",
      "{",
      "}",
      ": ",
      "- ",
      "? ",
      "&a ",
      "*a",
      "<<: *a",
      "---",
      "...",
      "%YAML 9",
      "!!str ",
      "|\n",
      ">-\n",
      "~",
      "null",
      ".nan",
      "-.inf",
      "#",
      "\n",
      "  ",
      "\t",
      "\"\\0",
      "\"\\x1b\"",
      "'",
      "0x1",
      "1e999",
      "-1",
      "99999999999999999999",
      "\xEF\xBB\xBF",
      "\xFF",
      "\xC2\x9B",
      "match_files",
      "folder: /dev",
      "file: /dev/zero",
      "[[[[[[[[[[[[[[[[[[[[[[[[[[",
      "{a: {a: {a: {a: {a: {a: {a: {a: {a: {a: {a: {a: {a: {a: {a: {a: {a: {a: {a: {a: {a: {"};
  return words;
}

TEST(MutatedInput, Studies) {
  std::vector<std::string> corpus = Corpus("tests/fuzz/corpus/study");
  corpus.push_back(SmallStudyYaml());
  for (const std::string& study : Corpus("studies")) corpus.push_back(study);
  const Outcomes outcomes = ReadDamaged(corpus, YamlWords(), 3000, [](const std::string& input) {
    const Study study = ParseStudy(input, "study.yaml");
    EXPECT_EQ(FindNotPlain(study.name), std::string::npos);
    ToYaml(study);
  });
  EXPECT_GT(outcomes.num_read, 100);  // else the mutants are too far from studies to reach the code behind
  EXPECT_GT(outcomes.num_refused, 1000);
}

// What is read is written, and read again as the same.
TEST(MutatedInput, NoiseFiles) {
  const std::string noise_file =
      "rcme_camera_noise: 1\n"
      "rests_on: {pairs: 12, matches: 3456, effective_pairs: 9.5, estimator: rcme_calibrated}\n"
      "camera: {width: 640, height: 480, fx: 700.5, fy: 701.25, cx: 319.5, cy: 239.5}\n"
      "sigma_px: {value: 0.25, standard_error: 0.01}\n"
      "size_exponent: {value: 0.5, standard_error: 0.125}\n"
      "key_point_px: 0.03\n"
      "displacement_field: {sd_px: 0.125, standard_error: 0.02, reach_px: 80, reach_factor: 1.25}\n"
      "unseen_field: {sd_px: 0.02, reach_px: 800}\n"
      "camera_faults:\n"
      "  focal_length: {value: 0.01, standard_error: 0.001, removed: 0.0098, uncertainty: 9e-4}\n"
      "  distortion: {value: 0.02, standard_error: 0.004, uncertainty: 0.003}\n"
      "correlations: [1, -0.5, -0.5, 1]\n"
      "uncertainty_correlations: [1, 0.25, 0.25, 1]\n"
      "systematic_displacement: {columns: 2, rows: 1, rms_px: 0.25, p_value: 0.002, dx_px: [0.1, -0.2], "
      "dy_px: [0.3, 0.4]}\n";
  const Outcomes outcomes = ReadDamaged({noise_file}, YamlWords(), 3000, [](const std::string& input) {
    const std::string written = CameraNoiseAsYaml(ParseCameraNoise(input, "noise.yaml"));
    EXPECT_EQ(CameraNoiseAsYaml(ParseCameraNoise(written, "noise.yaml")), written);
  });
  EXPECT_GT(outcomes.num_read, 10);  // every key is read, so that few changes leave a noise file
  EXPECT_GT(outcomes.num_refused, 1000);
}

TEST(MutatedInput, EstimatorFiles) {
  std::vector<std::string> corpus = Corpus("tests/fuzz/corpus/estimator_file");
  for (const std::string& file : Corpus("estimator_files")) corpus.push_back(file);
  const Outcomes outcomes = ReadDamaged(corpus, YamlWords(), 5000, [](const std::string& input) {
    EstimatorFileText(ParseEstimatorFile(input, "estimator.yaml"), {});
  });
  EXPECT_GT(outcomes.num_read, 100);
  EXPECT_GT(outcomes.num_refused, 1000);
}

TEST(MutatedInput, MatchFiles) {
  std::vector<std::string> corpus = Corpus("tests/fuzz/corpus/match_file");
  corpus.push_back("# scene: a\n" + MatchHeader() + TruePoseHeader() + "x1,y1,x2,y2\n" + MatchRows(8));
  const std::vector<std::string> words = {",",
                                          ",,,,",
                                          "\n",
                                          "\r\n",
                                          "#",
                                          "# size1: 1 1\n",
                                          ":",
                                          " ",
                                          "nan",
                                          "-inf",
                                          "1e999",
                                          "0x1p",
                                          "\t",
                                          "x1,y1,x2,y2\n",
                                          "\x1F\x8B",
                                          "1e6",
                                          "-1e6",
                                          "1e-320",
                                          "-0",
                                          "\xFF",
                                          "\xEF\xBB\xBF",
                                          "# scene: \x1B\n"};
  const TempFolder folder;
  const auto read = [&](const std::string& input) { ReadMatchFile(folder.Write("m.csv", input)); };
  // As many as this corpus and seed give: few, since most damage makes a K that cannot be that of the images.
  const Outcomes plain = ReadDamaged(corpus, words, 5000, read);
  EXPECT_GE(plain.num_read, 74);
  EXPECT_GT(plain.num_refused, 1000);
  const auto read_packed = [&](const std::string& input) { read(Gzip(input)); };
  EXPECT_GE(ReadDamaged(corpus, words, 1000, read_packed).num_read, 18);
  std::vector<std::string> packed;
  for (const std::string& input : corpus) packed.push_back(Gzip(input));
  EXPECT_GT(ReadDamaged(packed, words, 3000, read).num_refused, 1000);
}

// Lines of a match file that is read, for damage whose verdict is known.
class MatchLines {
 public:
  MatchLines(const std::string& text, RandomStream* rng) : rng_(*rng) {
    std::istringstream lines(text.starts_with(kMark) ? text.substr(3) : text);
    for (std::string line; std::getline(lines, line);) lines_.push_back(line);
  }

  // What changes nothing: blanks, comments, further columns, the order of the header.
  void ChangeHarmlessly() {
    switch (Below(8)) {
      case 0:
        Insert(Blanks());
        break;
      case 1:
        Insert("#" + Noise("\n:"));
        break;
      case 2:
        Insert("# note: " + Noise("\n"));
        break;
      case 3: {
        std::string& line = lines_[Below(lines_.size())];
        line = Blanks() + line + Blanks();
        break;
      }
      case 4: {
        std::string& line = lines_[PickRow()];
        line += "," + Noise("\n");
        break;
      }
      case 5: {
        std::string& line = lines_[PickRow()];
        line.replace(line.find(','), 1, Blanks() + "," + Blanks());
        break;
      }
      case 6: {
        std::string& line = lines_[PickHeader()];
        line.replace(line.find(':'), 1, Blanks() + ":" + Blanks());
        break;
      }
      default: {
        const size_t from = PickHeader();
        const std::string line = lines_[from];
        lines_.erase(lines_.begin() + static_cast<std::ptrdiff_t>(from));
        Insert(line);
      }
    }
  }

  // What no reader may overlook.
  void ChangeHarmfully() {
    const size_t row = PickRow(), header = PickHeader();
    switch (Below(5)) {
      case 0:  // too few columns
        lines_[row] = "1,2,3";
        break;
      case 1: {  // no coordinate
        static const std::vector<std::string> words = {"nan", "-inf", "1e999", "0x1p",
                                                       "",    "1e7",  "1 2",   "\xFF"};
        std::vector<std::string> fields = {"1", "2", "3", "4"};
        fields[Below(4)] = words[Below(words.size())];
        lines_[row] = fmt::format("{},5", fmt::join(fields, ","));
        break;
      }
      case 2:
        Insert(lines_[header]);  // the key stands twice
        break;
      case 3:
        lines_.erase(lines_.begin() + static_cast<std::ptrdiff_t>(header));  // the key is missing
        break;
      default:
        lines_.push_back("x1,y1,x2,y2");  // after the first match
    }
  }

  std::string Text() {
    const std::string text = fmt::format("{}", fmt::join(lines_, "\n"));
    return (Below(2) == 0 ? kMark : "") + text + (Below(2) == 0 ? "\n" : "");
  }

 private:
  static constexpr const char* kMark = "\xEF\xBB\xBF";

  size_t Below(size_t n) { return rng_.IntegerBelow(static_cast<std::uint32_t>(n)); }
  void Insert(const std::string& line) {
    lines_.insert(lines_.begin() + static_cast<std::ptrdiff_t>(Below(lines_.size() + 1)), line);
  }
  std::string Blanks() {
    std::string blanks;
    for (size_t i = Below(4); i > 0; --i) blanks += " \t\r"[Below(3)];
    return blanks;
  }
  // Up to 40 of all bytes but these.
  std::string Noise(const std::string& without) {
    std::string noise;
    for (size_t i = Below(40); i > 0; --i) {
      const char byte = static_cast<char>(Below(256));
      if (without.find(byte) == std::string::npos) noise += byte;
    }
    return noise;
  }
  // One of the lines that begin, after blanks, with a character of `begins` and hold `part`.
  size_t Pick(const std::string& begins, const std::string& part) {
    std::vector<size_t> found;
    for (size_t i = 0; i < lines_.size(); ++i) {
      const size_t first = lines_[i].find_first_not_of(" \t\r");
      if (first == std::string::npos || begins.find(lines_[i][first]) == std::string::npos) continue;
      if (lines_[i].find(part) != std::string::npos) found.push_back(i);
    }
    return found.at(Below(found.size()));
  }
  size_t PickRow() { return Pick("-0123456789", ","); }
  // Of a key that every file must have once.
  size_t PickHeader() {
    static const std::vector<std::string> keys = {"size1", "size2", "K1_fx_fy_cx_cy", "K2_fx_fy_cx_cy"};
    return Pick("#", keys[Below(keys.size())]);
  }

  std::vector<std::string> lines_;
  RandomStream& rng_;
};

// All that a reader gives, but for the numbers of lines in its doubts and the doubt about further columns.
std::string Described(const MatchFile& file) {
  const auto num_doubts = std::ranges::count_if(
      file.doubts, [](const InputDoubt& doubt) { return doubt.what.find("columns") == std::string::npos; });
  std::string text = fmt::format("{}|{}|{}\n", file.scene, file.matches.size(), num_doubts);
  for (const Camera& camera : {file.camera1, file.camera2}) {
    text += fmt::format("{} {} {} {} {} {}\n", camera.fx, camera.fy, camera.cx, camera.cy, camera.width,
                        camera.height);
  }
  for (const Correspondence& match : file.matches) {
    text += fmt::format("{} {} {} {}\n", match.x1_px.x(), match.x1_px.y(), match.x2_px.x(), match.x2_px.y());
  }
  if (const std::optional<RelativePose>& pose = file.cam2_from_cam1_true) {
    for (int row = 0; row < 3; ++row) {
      text += fmt::format("{} {} {} {}\n", pose->R(row, 0), pose->R(row, 1), pose->R(row, 2), pose->t(row));
    }
  }
  return text;
}

// Damage whose verdict follows from its kind: not one file that must be read may be lost or changed, and not
// one that must be refused may pass.
TEST(MutatedInput, MatchFilesAreReadOrRefusedByTheKindOfDamage) {
  const TempFolder folder;
  std::vector<std::string> corpus = Corpus("tests/fuzz/corpus/match_file");
  corpus.push_back("# scene: a\n" + MatchHeader() + TruePoseHeader() + "x1,y1,x2,y2\n" + MatchRows(8));
  // But for the one whose cameras cannot be, and for lenses, whose headers are not those that are changed.
  std::erase_if(corpus, [](const std::string& text) {
    return text.find("1e300") != std::string::npos || text.find("camera1") != std::string::npos;
  });
  ASSERT_GE(corpus.size(), 3u);
  RandomStream rng({.seed = kSeed, .purpose = 2733});
  for (const std::string& whole : corpus) {
    const std::string expected = Described(ReadMatchFile(folder.Write("m.csv", whole)));
    for (int i = 0; i < 500; ++i) {
      MatchLines lines(whole, &rng);
      for (std::uint32_t change = rng.IntegerBelow(8); change > 0; --change) lines.ChangeHarmlessly();
      std::string text = lines.Text();
      if (i % 2 == 1) text = Gzip(text);
      try {
        EXPECT_EQ(Described(ReadMatchFile(folder.Write("m.csv", text))), expected) << Printable(text, 10'000);
      } catch (const InputError& error) {
        ADD_FAILURE() << "refused: " << error.what() << "\n of " << Printable(text, 10'000);
      }
      lines.ChangeHarmfully();
      text = lines.Text();
      if (i % 2 == 1) text = Gzip(text);
      EXPECT_THROW(ReadMatchFile(folder.Write("m.csv", text)), InputError) << Printable(text, 10'000);
    }
  }
}

// Words of the files that data sets come with.
const std::vector<std::string>& DatasetWords() {
  static const std::vector<std::string> words = {"\n",
                                                 "\r\n",
                                                 ",",
                                                 " ",
                                                 "\t",
                                                 "#",
                                                 "nan",
                                                 "inf",
                                                 "1e999",
                                                 "-1",
                                                 "0",
                                                 "====",
                                                 "P0:",
                                                 "!!opencv-matrix",
                                                 "[",
                                                 "]",
                                                 "{",
                                                 "%YAML:1.0",
                                                 "..",
                                                 "/dev/zero",
                                                 "\xEF\xBB\xBF",
                                                 "\x1F\x8B",
                                                 "OPENCV",
                                                 "99999999999999999999",
                                                 std::string(8, '\xFF'),
                                                 std::string(8, '\0')};
  return words;
}

TEST(MutatedInput, Datasets) {
  struct Reader {
    const char* corpus;
    void (*read)(std::string_view);
  };
  for (const Reader& reader :
       {Reader{"euroc", ReadEurocInput}, Reader{"kitti", ReadKittiInput}, Reader{"tum", ReadTumInput},
        Reader{"colmap_model", ReadColmapBytesInput}, Reader{"colmap_model", ReadColmapTextInput}}) {
    const std::string corpus = std::string("tests/fuzz/corpus/") + reader.corpus;
    const Outcomes outcomes = ReadDamaged(Corpus(corpus), DatasetWords(), 1500, reader.read);
    EXPECT_GT(outcomes.num_read, 20) << reader.corpus;
    EXPECT_GT(outcomes.num_refused, 500) << reader.corpus;
  }
  const Outcomes tables = ReadDamaged(
      Corpus("tests/fuzz/corpus/colmap_database"), DatasetWords(), 1000, [](const std::string& input) {
        ReadColmapTablesInput(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
      });
  EXPECT_GT(tables.num_read, 5);
  EXPECT_GT(tables.num_refused, 200);
}

TEST(MutatedInput, ImageHeaders) {
  const std::vector<std::string> corpus = Corpus("tests/fuzz/corpus/image_header");
  const std::vector<std::string> words = {
      "\xFF\xC0", "\xFF\xD9", "\xFF\xFF\xFF\xFF", std::string(4, '\0'), "#", "\x7F\xFF", "IHDR",
      "II*",      "BM",       "9999999999"};
  int num_known = 0;
  ReadDamaged(corpus, words, 20'000, [&](const std::string& input) {
    const ImageHeader header = ReadImageHeader(input);
    num_known += !header.format.empty() && header.width > 0 && header.height > 0;
  });
  EXPECT_GT(num_known, 5000);
}

}  // namespace
}  // namespace rcme
