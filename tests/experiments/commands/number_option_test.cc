#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "experiments/commands/common_options.h"

namespace rcme {
namespace {

// What a program with these options reads, or its complaint.
struct Options {
  std::int64_t seed = 1;
  std::uint32_t trial = 7;
  double sigma_px = 0.5;
  std::vector<double> K1;
  std::string complaint;
};

Options Read(std::vector<std::string> arguments) {
  Options options;
  CLI::App app;
  app.add_option("--seed", options.seed)->transform(WholeNumberIn(0))->capture_default_str();
  app.add_option("--trial", options.trial)->transform(WholeNumberIn(0, 4294967295));
  app.add_option("--sigma", options.sigma_px)->transform(NumberIn({1e-9, 1000.0}));
  app.add_option("--K1", options.K1)->transform(NumberIn())->expected(4);
  std::ranges::reverse(arguments);  // as CLI11 wants them
  try {
    app.parse(arguments);
  } catch (const CLI::ParseError& error) {
    options.complaint = error.what();
  }
  return options;
}

TEST(NumberOption, ReadsDecimalNumbers) {
  EXPECT_EQ(Read({"--seed", "010"}).seed, 10);  // not octal
  EXPECT_EQ(Read({"--seed", "9223372036854775807"}).seed, 9223372036854775807);
  EXPECT_EQ(Read({"--trial", "4294967295"}).trial, 4294967295u);
  EXPECT_EQ(Read({"--sigma", "1e-9"}).sigma_px, 1e-9);
  EXPECT_EQ(Read({"--sigma", "0.1"}).sigma_px, 0.1);
  EXPECT_EQ(Read({"--K1", "600", "6e2", "-1.5", "0"}).K1, (std::vector<double>{600.0, 600.0, -1.5, 0.0}));
  EXPECT_EQ(Read({}).seed, 1);
}

TEST(NumberOption, SaysWhatIsAllowed) {
  const std::string whole = "' is not allowed; give a whole number in [0, ";
  for (const std::string bad : {"-1", "", " ", "1.5", "1e3", "0x10", "many", "99999999999999999999", "nan"}) {
    EXPECT_EQ(Read({"--seed", bad}).complaint, "--seed: '" + bad + whole + "9223372036854775807]");
    EXPECT_EQ(Read({"--trial", bad}).complaint, "--trial: '" + bad + whole + "4294967295]");
  }
  EXPECT_EQ(Read({"--trial", "4294967296"}).complaint, "--trial: '4294967296" + whole + "4294967295]");
  for (const std::string bad : {"0", "-1", "1000.1", "nan", "inf", "1e999", "", "0.5px"}) {
    EXPECT_EQ(Read({"--sigma", bad}).complaint,
              "--sigma: '" + bad + "' is not allowed; give a number in [1e-09, 1000]");
  }
  EXPECT_EQ(Read({"--K1", "600", "600", "nan", "0"}).complaint, "--K1: 'nan' is not allowed; give a number");
}

}  // namespace
}  // namespace rcme
