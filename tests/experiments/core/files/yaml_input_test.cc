#include "experiments/core/files/yaml_input.h"

#include <gtest/gtest.h>

#include "experiments/study/study_file.h"
#include "tests/test_support/expect_input_error.h"

namespace rcme {
namespace {

YAML::Node Parse(const std::string& yaml) { return ParseYaml(yaml, "a.yaml", {"file", "a file"}); }

TEST(ParseYaml, ReadsUtf8) {
  // The first and the last character of every length, and those beside the surrogates.
  for (const std::string text : {"\x7F", "\xC2\x80", "\xDF\xBF", "\xE0\xA0\x80", "\xED\x9F\xBF",
                                 "\xEE\x80\x80", "\xEF\xBF\xBF", "\xF0\x90\x80\x80", "\xF4\x8F\xBF\xBF"}) {
    EXPECT_NO_THROW(Parse("# " + text + "\na: 1\n"));
  }
  EXPECT_EQ(Parse("\xEF\xBB\xBFname: caf\xC3\xA9\n")["name"].Scalar(), "caf\xC3\xA9");
}

TEST(ParseYaml, RefusesWhatIsNotUtf8) {
  EXPECT_TRUE(ThrowsInputError([] { Parse("a: 1\nname: caf\xE9\n"); },
                               {"a.yaml:2: byte 0xE9 is not UTF-8", "save the file as UTF-8"}));
  // Lone and missing continuation bytes, longer forms than needed, surrogates, beyond U+10FFFF, cut off.
  for (const std::string text :
       {"\x80", "\xC3(", "\xE2\x82(", "\xF0\x9F\x98(", "\xC0\x80", "\xC1\xBF", "\xE0\x9F\xBF",
        "\xF0\x8F\xBF\xBF", "\xED\xA0\x80", "\xED\xBF\xBF", "\xF4\x90\x80\x80", "\xF5\x80\x80\x80", "\xFF",
        "\xC3", "\xE2\x82", "\xF0\x9F\x98"}) {
    EXPECT_TRUE(ThrowsInputError([&] { Parse("a: 1\n\n# " + text); }, {"a.yaml:3:", "is not UTF-8"}));
  }
}

TEST(ParseYaml, RefusesTheByteZero) {
  EXPECT_TRUE(ThrowsInputError([] { Parse(std::string("a: 1\nb: 2\n\0garbage: 3\n", 23)); },
                               {"a.yaml:3: byte 0x00 is no text"}));
}

TEST(Entries, AMissingValueIsNamedWithTheLineOfItsKey) {
  const auto refuses = [](const std::string& yaml, const std::string& what) {
    return ThrowsInputError([&] { ParseStudy(yaml, "a.yaml"); }, {what});
  };
  EXPECT_TRUE(refuses("seed: 3\ntrials:\n\ndata: {scene: corridor}\n",
                      "a.yaml:2: study: the value of 'trials' is missing"));
  EXPECT_TRUE(refuses("data:\n  num_matches:\n  scene: corridor\n",
                      "a.yaml:2: data: the value of 'num_matches' is missing"));
  EXPECT_TRUE(refuses("data: {scene: corridor}\nestimators:\n  - name: rcme\n    options:\n  - name: prcme\n",
                      "a.yaml:4: estimators: the value of 'options' is missing"));
  EXPECT_TRUE(refuses("data: {scene: corridor}\nestimators:\n",
                      "a.yaml:2: study: the value of 'estimators' is missing"));
  EXPECT_TRUE(refuses("data: {scene: corridor}\nfactors: {sigma_px: [1, ~]}\n",
                      "a.yaml:2: sigma_px: the value is missing"));
}

}  // namespace
}  // namespace rcme
