#include "experiments/audit/validity/validity_map.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <sstream>
#include <string>

#include "experiments/audit/validity/map_work.h"
#include "experiments/audit/validity/validity_reference.h"
#include "experiments/core/table/render_table.h"
#include "stats/intervals.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/in_memory.h"
#include "tests/test_support/run_program.h"

namespace rcme {
namespace {

using Row = std::map<std::string, std::string>;

std::vector<Row> ParseRows(const std::string& csv) {
  const auto split = [](const std::string& line) {
    std::vector<std::string> fields;
    std::istringstream in(line);
    for (std::string field; std::getline(in, field, ',');) fields.push_back(field);
    return fields;
  };
  std::istringstream in(csv);
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> header = split(line);
  std::vector<Row> rows;
  while (std::getline(in, line)) {
    const std::vector<std::string> fields = split(line);
    EXPECT_EQ(fields.size(), header.size()) << line;
    rows.emplace_back();
    for (size_t c = 0; c < header.size(); ++c) rows.back()[header[c]] = fields[c];
  }
  return rows;
}

// The one row with these values.
Row Find(const std::vector<Row>& rows, const Row& wanted) {
  std::vector<Row> found;
  for (const Row& row : rows) {
    bool fits = true;
    for (const auto& [key, value] : wanted) fits = fits && row.at(key) == value;
    if (fits) found.push_back(row);
  }
  EXPECT_EQ(found.size(), 1u);
  return found.at(0);
}

Interval ExactAt9999(const Row& row) {
  return ExactBinomialInterval(std::stoll(row.at("num_covered")), std::stoll(row.at("n")), 1.0 - 1e-4);
}

ValidityMapOptions SmallMap(int trials) {
  return {
      .sigmas_px = {1e-4, 0.5}, .nums_points = {8, 20}, .conditions = AtBaselines({0.5}), .trials = trials};
}

TEST(ValidityMap, ThreadsChangeNothing) {
  ValidityMapOptions options = SmallMap(50);
  const std::string one = MapCsvInMemory(options, 1);
  EXPECT_EQ(ParseRows(one).size(), 4u * 7u * 4u);  // cells, groups, quantities
  for (const int num_threads : {2, 5}) {
    EXPECT_EQ(MapCsvInMemory(options, num_threads), one) << num_threads << " threads";
  }
  options.seed = 2;
  EXPECT_NE(MapCsvInMemory(options), one);
}

TEST(ValidityMap, CoversWhereNoiseIsSmallAndShowsWhatWasMeasuredElsewhere) {
  // At 1e-4 px Sigma_f, the fresh match and m = 20 cover 0.95: false alarm 1e-4 each. Sigma_p of eight points
  // covered 0.947 there in another measurement, which 3,000 trials cannot tell from 0.95. At 0.5 px that
  // measurement (two cameras of different focal lengths) gave 0.787 for Sigma_f and 0.632 for Sigma_p, n =
  // 20,000: here within 0.05, more than the interval's 0.03 for the difference of the cameras.
  const std::vector<Row> rows = ParseRows(MapCsvInMemory(SmallMap(3'000)));
  for (const std::string m : {"8", "20"}) {
    for (const std::string quantity : {"f", "pose", "fresh_point", "ml_pose"}) {
      const Row row = Find(
          rows, {{"sigma_px", "0.0001"}, {"num_points", m}, {"conditioning", "all"}, {"quantity", quantity}});
      EXPECT_EQ(row.at("n"), "3000");
      EXPECT_TRUE(ExactAt9999(row).Contains(0.95)) << m << " " << quantity << " " << row.at("coverage");
    }
  }
  const auto coverage = [&](const std::string& m, const std::string& quantity) {
    return std::stod(
        Find(rows, {{"sigma_px", "0.5"}, {"num_points", m}, {"conditioning", "all"}, {"quantity", quantity}})
            .at("coverage"));
  };
  EXPECT_NEAR(coverage("8", "pose"), 0.632, 0.05);
  EXPECT_NEAR(coverage("8", "f"), 0.787, 0.05);
  EXPECT_GT(coverage("20", "pose"), coverage("8", "pose"));
}

TEST(ValidityMap, ThirdsAddUpToAllAndAreInOrder) {
  const std::vector<Row> rows = ParseRows(MapCsvInMemory(SmallMap(100)));
  for (const std::string quantity : {"f", "pose", "fresh_point", "ml_pose"}) {
    const Row cell = {{"sigma_px", "0.5"}, {"num_points", "8"}, {"quantity", quantity}};
    const auto with = [&](const std::string& group) {
      Row wanted = cell;
      wanted["conditioning"] = group;
      return Find(rows, wanted);
    };
    for (const std::string measure : {"exact", "observed"}) {
      int n = 0, num_covered = 0;
      double last_median = 0.0;
      for (const std::string third : {"_lower", "_middle", "_upper"}) {
        const Row row = with(measure + third);
        n += std::stoi(row.at("n"));
        num_covered += std::stoi(row.at("num_covered"));
        EXPECT_GT(std::stod(row.at("median_conditioning")), last_median);
        last_median = std::stod(row.at("median_conditioning"));
      }
      EXPECT_EQ(n, 100);
      EXPECT_EQ(num_covered, std::stoi(with("all").at("num_covered")));
    }
  }
}

TEST(ValidityMap, ParallaxGrowsWithTheBaseline) {
  ValidityMapOptions options = SmallMap(200);
  options.conditions = AtBaselines({0.1, 1.5});
  const std::vector<Row> rows = ParseRows(MapCsvInMemory(options));
  const auto parallax_deg = [&](const std::string& baseline) {
    return std::stod(Find(rows, {{"sigma_px", "0.5"},
                                 {"num_points", "8"},
                                 {"baseline_m", baseline},
                                 {"conditioning", "all"},
                                 {"quantity", "f"}})
                         .at("median_parallax_deg"));
  };
  // A baseline b across the line of sight is seen from depth z under b / z: 0.1 / 5 = 1.1 deg; most are not
  // across.
  EXPECT_GT(parallax_deg("0.1"), 0.6);
  EXPECT_LT(parallax_deg("0.1"), 1.2);
  EXPECT_GT(parallax_deg("1.5"), 9.0);
}

ValidityReferenceOptions SmallReference() {
  return {
      .sigmas_px = {1e-4}, .nums_points = {8, 20}, .num_samples = 20, .num_draws = 60, .num_noises = 2'000};
}

TEST(ValidityReference, AllCovariancesAgreeWhereNoiseIsSmall) {
  // False alarm 1e-4 a row. The Monte-Carlo covariance from 2,000 noises covers 0.949 of Gaussian errors
  // (Hotelling), which 1,200 draws cannot tell from 0.95.
  const std::vector<Row> rows = ParseRows(ReferenceCsvInMemory(SmallReference()));
  EXPECT_EQ(rows.size(), 2u * 2u * 4u);
  for (const Row& row : rows) {
    EXPECT_EQ(row.at("n"), "1200");
    EXPECT_TRUE(ExactAt9999(row).Contains(0.95)) << row.at("num_points") << " " << row.at("quantity") << " "
                                                 << row.at("covariance") << " " << row.at("coverage");
  }
}

TEST(ValidityReference, ThreadsChangeNothing) {
  ValidityReferenceOptions options = SmallReference();
  options.num_noises = 50;
  EXPECT_EQ(ReferenceCsvInMemory(options, 3), ReferenceCsvInMemory(options, 1));
}

void Part(const MapWork& work, const Shard& shard, const std::string& path) {
  Runner runner = Runner::OfShard(PlanMapWork(work), shard, path, 2);
  GetMapResults(work, &runner);
}

// In shards the tables are those of one machine, to the last byte; a trial may have no sample.
TEST(MapParts, GiveTheBytesOfOneMachine) {
  MapWork work{SmallMap(130), ValidityReferenceOptions{}, ""};
  work.reference->num_samples = 4;
  work.reference->num_noises = work.reference->num_draws = 20;
  const auto sampler = work.map.conditions.front().sampler;
  work.map.conditions.front().sampler = [sampler](int num_points, double sigma_px) -> MapSampler {
    const MapSampler draw = sampler(num_points, sigma_px);
    return [draw](const StreamName& name) { return name.trial % 3 == 1 ? std::nullopt : draw(name); };
  };
  const std::string map = MapCsvInMemory(work.map), reference = ReferenceCsvInMemory(*work.reference);
  EXPECT_NE(map.find(",87,"), std::string::npos) << "n: two thirds of 130";
  const WorkPlan pieces = PlanMapWork(work);
  EXPECT_EQ(ListItems(pieces, {}).size(), 4u * 2u + 6u * 4u);
  const TempFolder folder;
  for (const std::uint32_t count : {7, 64}) {
    std::vector<std::string> paths;
    for (std::uint32_t number = count; number >= 1; --number) {
      paths.push_back(folder.Path(fmt::format("{}_of_{}", number, count)));
      Part(work, {number, count}, paths.back());
    }
    const WorkResults merged = MergeParts(pieces, paths);
    EXPECT_EQ(FindMissingIn(pieces, merged, 0, pieces.groups.size()).num_items, 0);
    EXPECT_EQ(RenderCsv(MakeValidityMapTable(work.map, TrialsIn(work, pieces, merged))), map);
    EXPECT_EQ(RenderCsv(MakeValidityReferenceTable(*work.reference, CountsIn(work, pieces, merged))),
              reference);
  }
}

TEST(MapParts, OfAnotherSeedAreRefused) {
  const TempFolder folder;
  const std::string path = folder.Path("part.json");
  MapWork work{SmallMap(3), std::nullopt, ""};
  Part(work, {1, 1}, path);
  work.map.seed = 2;
  EXPECT_TRUE(ThrowsInputError([&] { Part(work, {1, 1}, path); }, {path, "'seed: 1' there, 'seed: 2' here"}));
}

TEST(MapParts, DamageIsNamed) {
  MapWork work{SmallMap(3), ValidityReferenceOptions{}, ""};
  work.reference->num_samples = work.reference->num_noises = work.reference->num_draws = 20;
  const WorkPlan pieces = PlanMapWork(work);
  const auto is_refused = [&](size_t group, const std::string& result, const std::string& word) {
    const WorkResults merged{1, {{{group, 0}, {result, 0.0}}}, {{{group, 0}, "a.json"}}, ""};
    const auto read = [&] {
      TrialsIn(work, pieces, merged)(0);
      CountsIn(work, pieces, merged)(0);
    };
    return ThrowsInputError(read, {"a.json: damaged: block 0 of " + pieces.groups[group].name, word});
  };
  EXPECT_TRUE(is_refused(0, "[[1,1,1,1,1,1]]", "no list of 7"));
  EXPECT_TRUE(is_refused(0, "[[1,1,1,1,1,1,\"x\"]]", "a number that is none"));
  // f, pose, fresh point, ml pose; exact and observed conditioning, parallax.
  EXPECT_TRUE(is_refused(0, "[[1,1,1,1,1.5,1,1]]", "a conditioning of 1.5, not of 0 to 1"));
  EXPECT_TRUE(is_refused(0, "[[1,1,1,1,1,-0.5,1]]", "a conditioning of -0.5, not of 0 to 1"));
  EXPECT_TRUE(is_refused(0, "[[1,1,1,1,1,1,4]]", "a parallax of 4 rad, not of 0 to pi"));
  EXPECT_TRUE(is_refused(0, "[[],[],[],[]]", "no list of up to 3 trials"));
  EXPECT_TRUE(is_refused(4, "[[1,1,1,1]]", "no list of 2"));
  EXPECT_TRUE(is_refused(4, "[[1,1,1,1],[1,1,21,1]]", "a count of 21, not of 0 to 20"));
  EXPECT_TRUE(is_refused(4, "[[1,1,1,1],[1,1,-1,1]]", "a count of -1, not of 0 to 20"));
}

TEST(MapCommand, WritesBothTablesAndPrintsTheirPaths) {
  const TempFolder folder;
  const std::string out = folder.Path("new/map");
  const ProgramResult result = RunRcme({"map", "--out", out, "--trials", "3", "--threads", "2"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, out + "/validity_map.csv\n" + out + "/validity_reference.csv\n");
  const std::vector<Row> map = ParseRows(ReadBytes(out + "/validity_map.csv"));
  EXPECT_EQ(map.size(), 120u * 7u * 4u);
  EXPECT_EQ(ParseRows(ReadBytes(out + "/validity_reference.csv")).size(), 6u * 2u * 4u);
}

TEST(MapCommand, RefusesAPlaceThatCannotBeWritten) {
  const TempFolder folder;
  const std::string file = folder.Write("file", "");
  const ProgramResult result = RunRcme({"map", "--out", file + "/map", "--trials", "3"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find(file), std::string::npos) << result.err;
  EXPECT_EQ(RunRcme({"map"}).exit_code, 2);
  EXPECT_EQ(RunRcme({"map", "--out", folder.path(), "--trials", "0"}).exit_code, 2);
  EXPECT_EQ(folder.NumEntries(), 1);
}

}  // namespace
}  // namespace rcme
