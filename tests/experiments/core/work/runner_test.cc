// A work in shards: every piece once, whatever was stopped, merged twice or in groups; what does not belong
// together is refused.
#include "experiments/core/work/runner.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>

#include "experiments/core/files/file_output.h"
#include "experiments/core/work/stop_request.h"
#include "tests/test_support/changed_part.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

using Paths = std::vector<std::string>;
using Json = nlohmann::ordered_json;

WorkPlan Plan() { return {"knitting", "row", "wool: red\n", {{"sleeve", 9}, {"collar", 2}, {"front", 20}}}; }

std::string Knit(const ItemPlace& place) { return fmt::format("[{},{}]", place.group, place.item); }

// What was done, in order; a piece that is done twice is in it twice.
std::string JoinResults(const WorkResults& merged) {
  std::string text;
  ReadResults(Plan(), merged, 0, 3, [&](const ItemPlace& place, const std::string& json) {
    EXPECT_EQ(json, Knit(place));
    text += json;
  });
  return text;
}

class RunnerOfShards : public testing::Test {
 protected:
  std::string Path(std::uint32_t number, std::uint32_t count) const {
    return folder_.Path(fmt::format("{}_of_{}.json", number, count));
  }
  // The shard's part; the work is stopped after `most` pieces.
  std::string Part(std::uint32_t number, std::uint32_t count, int most = 1000,
                   const WorkPlan& plan = Plan()) const {
    Runner runner = Runner::OfShard(plan, {number, count}, Path(number, count), 1);
    runner.Get(ListItems(plan, {number, count}), [&](const ItemPlace& place) {
      if (most-- == 0) throw Stopped("now");
      return Knit(place);
    });
    return Path(number, count);
  }
  Paths Parts(std::uint32_t count) const {
    Paths paths;
    for (std::uint32_t number = 1; number <= count; ++number) paths.push_back(Part(number, count));
    return paths;
  }
  std::string Joined(const Paths& paths, const std::string& name) const {
    const std::string path = folder_.Path(name);
    const auto joined = JoinParts(paths);
    WritePart(path, joined, joined.results);
    return path;
  }
  static bool IsRefused(const Paths& paths, const Paths& words, const WorkPlan& plan = Plan()) {
    return ThrowsInputError([&] { MergeParts(plan, paths); }, words);
  }

  const TempFolder folder_;
};

TEST_F(RunnerOfShards, AnyNumberOrderAndGroupingHoldEveryPieceOnce) {
  std::string whole;
  for (const ItemPlace& place : ListItems(Plan(), {})) whole += Knit(place);
  EXPECT_EQ(ListItems(Plan(), {}).size(), 31U);
  for (const std::uint32_t count : {1, 2, 7, 64}) {
    Paths paths = Parts(count);
    for (int order = 0; order < 3; ++order) {
      const WorkResults merged = MergeParts(Plan(), paths);
      EXPECT_EQ(JoinResults(merged), whole);
      EXPECT_EQ(merged.num_shards, count);
      EXPECT_EQ(FindMissingIn(Plan(), merged, 0, 3).num_items, 0);
      std::ranges::reverse(paths);
      std::ranges::rotate(paths, paths.begin() + count / 3);
    }
    const auto half = paths.begin() + count / 2;
    Paths groups = {Joined({half, paths.end()}, "second"), paths.front()};  // a part is there twice
    if (count > 1) groups.push_back(Joined({paths.begin(), half}, "first"));
    EXPECT_EQ(JoinResults(MergeParts(Plan(), groups)), whole);
    EXPECT_EQ(JoinResults(MergeParts(Plan(), {Joined(groups, "all")})), whole);
  }
}

TEST_F(RunnerOfShards, TheGroupsThatAreAskedForAreReadAlone) {
  const WorkResults merged = MergeParts(Plan(), Parts(2));
  int num_rows = 0;
  ReadResults(Plan(), merged, 1, 2, [&](const ItemPlace& place, const std::string&) {
    EXPECT_EQ(place.group, 1u);
    ++num_rows;
  });
  EXPECT_EQ(num_rows, 2);
}

TEST(WorkPlan, EndsWithTheLastItemOfEachGroup) {
  EXPECT_TRUE(Plan().Has({0, 8}));
  EXPECT_FALSE(Plan().Has({0, 9}));
  EXPECT_TRUE(Plan().Has({2, 19}));
  EXPECT_FALSE(Plan().Has({3, 0}));
}

TEST_F(RunnerOfShards, AGroupIsDividedEvenlyToWithinOnePiece) {
  for (const std::uint32_t count : {1, 4, 7, 64}) {
    for (size_t group = 0; group < 3; ++group) {
      const size_t num_items = Plan().groups[group].num_items;
      for (std::uint32_t number = 1; number <= count; ++number) {
        const size_t has = ListItems(Plan(), {number, count}, group, group + 1).size();
        EXPECT_GE(has, num_items / count);
        EXPECT_LE(has, (num_items + count - 1) / count);
      }
    }
  }
}

TEST_F(RunnerOfShards, WhatIsStoppedIsKeptAndGoesOn) {
  const size_t num_items = ListItems(Plan(), {1, 2}).size();
  for (int done = 0; done + 3 <= static_cast<int>(num_items); done += 3) {
    EXPECT_THROW(Part(1, 2, 3), Stopped);
    EXPECT_EQ(PartAsJson(Path(1, 2)).at("pieces").size(), static_cast<size_t>(done + 3));
  }
  Part(1, 2);
  EXPECT_EQ(PartAsJson(Path(1, 2)).at("pieces").size(), num_items);
  EXPECT_NO_THROW(Part(1, 2, 0));  // nothing is left
  try {
    Part(2, 2, 4);
    FAIL();
  } catch (const Stopped& stopped) {
    const std::string words = stopped.what();
    EXPECT_NE(words.find(fmt::format("4 of at most {} rows", 31 - num_items)), std::string::npos) << words;
  }
}

TEST_F(RunnerOfShards, ARequestStopsItBetweenTwoPieces) {
  StopOnSignals stop;
  Runner runner = Runner::OfShard(Plan(), {1, 1}, Path(1, 1), 1);
  EXPECT_THROW(runner.Get(ListItems(Plan(), {}),
                          [](const ItemPlace& place) {
                            if (place == ItemPlace{0, 2}) std::raise(SIGTERM);
                            return Knit(place);
                          }),
               Stopped);
  EXPECT_EQ(PartAsJson(Path(1, 1)).at("pieces").size(), 3);
  const StopOnSignals forgets_the_signal;
}

TEST_F(RunnerOfShards, MissingShardsAreNamed) {
  Paths paths = Parts(7);
  paths.erase(paths.begin() + 4);
  paths[1] = ChangedPart(paths[1], [](Json* part) { part->at("pieces").erase(0); });
  const WorkResults merged = MergeParts(Plan(), paths);
  const MissingItems missing = FindMissingIn(Plan(), merged, 0, 3);
  EXPECT_EQ(missing.num_items, 1 + ListItems(Plan(), {5, 7}).size());
  EXPECT_EQ(missing.shards, (std::vector<std::uint32_t>{2, 5}));
  // Of one group alone.
  EXPECT_EQ(FindMissingIn(Plan(), merged, 2, 3).num_items, ListItems(Plan(), {5, 7}, 2, 3).size());
  // Of nothing at all.
  EXPECT_EQ(FindMissingIn(Plan(), MergeParts(Plan(), {}), 0, 3).num_items, 31);
}

TEST_F(RunnerOfShards, WhatDoesNotBelongTogetherIsRefused) {
  const std::string first = Part(1, 3), second = Part(2, 3);
  const auto changed = [&](const std::string& key, const std::string& value) {
    return ChangedPart(first, [&](Json* part) { part->at(key) = value; });
  };
  const std::string program = changed("program", "rcme 0.0.1");
  EXPECT_TRUE(IsRefused({second, program}, {program, "another program, 'rcme 0.0.1' there"}));
  EXPECT_TRUE(IsRefused({program}, {program, "this knitting", "another program, 'rcme 0.0.1' there"}));
  const std::string machine = changed("instruction_set", "abacus");
  EXPECT_TRUE(IsRefused({second, machine}, {machine, second, "another instruction set, 'abacus' there"}));
  EXPECT_TRUE(ThrowsInputError([&] { JoinParts({second, machine}); }, {machine, second, "abacus"}));
  const std::string work = changed("work", "sewing");
  EXPECT_TRUE(IsRefused({work}, {work, "this knitting", "'sewing' there, 'knitting' here"}));
  EXPECT_TRUE(ThrowsInputError([&] { JoinParts({second, work}); }, {work, second, "sewing"}));
  const std::string of_seven = Part(1, 7);
  EXPECT_TRUE(IsRefused({second, of_seven}, {of_seven, "number of shards, '7' there, '3' here"}));

  WorkPlan wool = Plan(), longer = Plan();
  wool.identity = "wool: blue\n";
  longer.groups[0].num_items = 10;
  EXPECT_TRUE(IsRefused({first}, {first, "another knitting", "'wool: red' there, 'wool: blue' here"}, wool));
  EXPECT_TRUE(IsRefused({first}, {"'sleeve: 9 rows' there, 'sleeve: 10 rows' here"}, longer));
  EXPECT_TRUE(ThrowsInputError([&] { Part(1, 3, 1000, wool); }, {first, "wool: red"}));
  const std::string before = PartAsJson(second).dump();
  EXPECT_TRUE(ThrowsInputError(
      [&] {
        Runner::OfShard(Plan(), {1, 3}, second, 1);
      },
      {second, "another shard", "'2/3' there, '1/3' here"}));
  EXPECT_TRUE(ThrowsInputError(
      [&] {
        Runner::OfShard(Plan(), {1, 3}, changed("instruction_set", "abacus"), 1);
      },
      {machine, "another instruction set, 'abacus' there"}));
  EXPECT_EQ(PartAsJson(second).dump(), before);
}

TEST_F(RunnerOfShards, APieceThatIsThereTwiceCountsOnceOrIsRefused) {
  const std::string part = Part(1, 3);
  const std::string later = ChangedPart(
      part, [](Json* json) { json->at("pieces").at(0).at("seconds") = 17.5; });  // its time may differ
  EXPECT_EQ(MergeParts(Plan(), {part, later}).results.size(), ListItems(Plan(), {1, 3}).size());
  const std::string other = ChangedPart(part, [](Json* json) { json->at("pieces").at(0).at("result") = 5; });
  const std::string row = fmt::format("row {} of sleeve", ListItems(Plan(), {1, 3}).front().item);
  EXPECT_TRUE(IsRefused({part, other}, {other, row, "is not equal to that of", part}));
  EXPECT_TRUE(ThrowsInputError([&] { JoinParts({part, other}); }, {other, "not equal", part}));
}

// Four pieces of 1, 2, 3 and 6 s of the three shards 1, 2, 3 and 1 of a group: 7, 2 and 3 s, 4 in the mean.
TEST_F(RunnerOfShards, SaysWhatThePiecesTook) {
  WorkResults merged{3, {}, {}, ""};
  EXPECT_EQ(DescribeCosts(Plan(), merged), "the pieces took no time");
  const double seconds[] = {1.0, 2.0, 3.0, 6.0};
  for (size_t piece = 0; piece < 4; ++piece) {
    EXPECT_EQ(FindShardOfItem({0, piece}, 3), piece % 3 + 1);
    merged.results[{0, piece}].seconds = seconds[piece];
  }
  EXPECT_EQ(
      DescribeCosts(Plan(), merged),
      "processor time 12 s; the slowest of 3 shards 1.75 times the mean, the slowest row 1.50 times (row "
      "3 of sleeve)");
}

TEST_F(RunnerOfShards, DamageIsNamed) {
  const std::string part = Part(1, 2);
  const auto is_refused = [&](const std::function<void(Json*)>& change, const std::string& word) {
    return IsRefused({ChangedPart(part, change)}, {part, word});
  };
  const auto piece = [](Json* p) -> Json& { return p->at("pieces").at(0); };
  EXPECT_TRUE(is_refused([](Json* p) { p->at("format") = "rcme part 0"; }, "its format is 'rcme part 0'"));
  EXPECT_TRUE(is_refused([](Json* p) { p->at("shard") = 3; }, "there is no shard 3 of 2"));
  EXPECT_TRUE(is_refused([](Json* p) { p->at("num_shards") = 0; }, "there is no shard 1 of 0"));
  const auto alone = [&](const char* key, int number) {
    return [&piece, key, number](Json* p) {
      piece(p).at(key) = number;
      p->at("pieces") = Json::array({piece(p)});
    };
  };
  EXPECT_TRUE(is_refused(alone("group", 3), "group 3 is none of its shard"));
  EXPECT_TRUE(is_refused(alone("piece", 9), "row 9 of group 0 is none of its shard"));
  EXPECT_TRUE(is_refused([](Json* p) { p->at("shard") = 2; }, "is none of its shard"));
  EXPECT_TRUE(is_refused([&](Json* p) { p->at("pieces").at(1) = piece(p); }, "is there twice"));
  EXPECT_TRUE(is_refused([&](Json* p) { std::swap(p->at("pieces").at(1), piece(p)); }, "out of order"));
  EXPECT_TRUE(is_refused([&](Json* p) { piece(p).erase("result"); }, "the line is no piece"));
  EXPECT_TRUE(is_refused([&](Json* p) { piece(p).at("seconds") = -1; }, "the line is no piece"));
  EXPECT_TRUE(is_refused([](Json* p) { p->at("work") = Json::array({Json::array()}); }, "describes no part"));
  EXPECT_TRUE(ThrowsInputError(
      [&] {
        ReadResults(Plan(), MergeParts(Plan(), {part}), 1, 3,
                    [](const ItemPlace&, const std::string&) { throw std::invalid_argument("a hole"); });
      },
      {part, "damaged", "of collar", "a hole"}));

  const std::string text = ReadBytes(part);
  const std::string cut = folder_.Write("cut.json", text.substr(0, text.size() / 2));
  EXPECT_TRUE(IsRefused({cut}, {cut, "damaged"}));
  const std::string shorter =
      folder_.Write("shorter.json", text.substr(0, text.rfind('\n', text.size() - 2) + 1));
  EXPECT_TRUE(IsRefused({shorter}, {shorter, "pieces, not"}));
  EXPECT_TRUE(IsPart(cut));
  EXPECT_FALSE(IsPart(folder_.Write("no.json", "{}")));
  EXPECT_FALSE(IsPart(folder_.Path("none.json")));
  EXPECT_TRUE(IsRefused({folder_.Path("none.json")}, {"none.json", "no such part"}));
}

// A command on one machine, which keeps its results until it is done.
class RunnerWithCheckpoint : public testing::Test {
 protected:
  // Calls of `compute` until it is stopped, or throws what `end` says.
  int Run(
      int num_threads, const std::function<void(int call)>& end = [](int) {}) {
    Runner runner = Runner::WithCheckpoint(Plan(), path_, num_threads);
    std::atomic<int> num_calls = 0;
    try {
      runner.Get(ListItems(Plan(), {}), [&](const ItemPlace& place) {
        end(++num_calls);
        return Knit(place);
      });
    } catch (const std::exception& error) {
      message_ = error.what();
      return num_calls;
    }
    all_ = JoinResults(runner.results());
    runner.RemoveCheckpoint();
    return num_calls;
  }
  size_t NumKept() const { return ReadPart(path_).results.size(); }

  const TempFolder folder_;
  const std::string path_ = folder_.Path("unfinished.part");
  std::string message_, all_;
};

TEST_F(RunnerWithCheckpoint, GivesTheSameOnAnyNumberOfThreadsAndLeavesNothing) {
  for (const int num_threads : {1, 2, 5}) {
    EXPECT_EQ(Run(num_threads), 31);
    std::string whole;
    for (const ItemPlace& place : ListItems(Plan(), {})) whole += Knit(place);
    EXPECT_EQ(all_, whole);
    EXPECT_EQ(folder_.NumEntries(), 0);
  }
}

TEST_F(RunnerWithCheckpoint, KeepsWhatIsDoneWhenItIsStoppedAndComputesNothingTwice) {
  {
    const StopOnSignals stop;
    EXPECT_EQ(Run(1,
                  [](int call) {
                    if (call == 5) std::raise(SIGTERM);
                  }),
              5);
  }
  EXPECT_EQ(NumKept(), 5u);
  EXPECT_NE(message_.find(path_ + " has 5 of at most 31 rows, the same command goes on"), std::string::npos)
      << message_;
  const StopOnSignals forgets_the_signal;
  EXPECT_EQ(Run(2), 26);
  EXPECT_EQ(folder_.NumEntries(), 0);
}

TEST_F(RunnerWithCheckpoint, KeepsWhatIsDoneBeforeAnError) {
  EXPECT_EQ(Run(1,
                [](int call) {
                  if (call == 8) throw InputError("no wool");
                }),
            8);
  EXPECT_EQ(message_, "no wool");
  EXPECT_EQ(NumKept(), 7u);
  EXPECT_EQ(Run(1), 24);
}

TEST_F(RunnerWithCheckpoint, RefusesOtherWorkAndWhatIsDamaged) {
  Run(1, [](int call) {
    if (call == 8) throw InputError("no wool");
  });
  WorkPlan blue = Plan();
  blue.identity = "wool: blue\n";
  const auto open = [&](const WorkPlan& plan) {
    return [=, this] { Runner::WithCheckpoint(plan, path_, 1); };
  };
  EXPECT_TRUE(ThrowsInputError(open(blue), {path_, "'wool: red' there, 'wool: blue' here",
                                            "remove the file or choose another --out"}));
  WorkPlan sewing = Plan();
  sewing.work = "sewing";
  EXPECT_TRUE(ThrowsInputError(open(sewing), {path_, "another work, 'knitting' there", "choose another"}));
  EXPECT_EQ(NumKept(), 7u);
  std::string bytes = ReadBytes(path_);
  bytes[60] ^= 1;  // of the first line: nothing says what the others are of
  folder_.Write("unfinished.part", bytes);
  EXPECT_TRUE(
      ThrowsInputError(open(Plan()), {path_, "damaged", "remove the file and run the command again"}));
}

// One damaged line costs its own item alone, and an end that is cut off what it held.
TEST_F(RunnerWithCheckpoint, KeepsTheSoundLinesOfADamagedFile) {
  EXPECT_EQ(Run(1), 31);
  const std::string all = all_;
  for (const bool is_cut_off : {false, true}) {
    Run(1, [](int call) {
      if (call == 8) throw InputError("no wool");
    });
    std::string bytes = ReadBytes(path_);
    const size_t second_line = bytes.find('\n', bytes.find('\n') + 1) + 1;
    if (is_cut_off)
      bytes.resize(second_line + 20);  // one sound line, and a beginning
    else
      bytes[second_line + 20] ^= 1;
    folder_.Write("unfinished.part", bytes);
    testing::internal::CaptureStderr();
    EXPECT_EQ(Run(1), is_cut_off ? 30 : 25);
    const std::string warning = testing::internal::GetCapturedStderr();
    EXPECT_NE(warning.find(path_), std::string::npos) << warning;
    EXPECT_NE(warning.find(is_cut_off ? "1 sound rows are kept, 6 of the file are lost and made again"
                                      : "6 sound rows are kept, 1 of the file are lost and made again"),
              std::string::npos)
        << warning;
    EXPECT_EQ(all_, all);
  }
}

TEST_F(RunnerWithCheckpoint, AFileThatCannotBeWrittenIsAnErrorOfItsOwn) {
  const std::string folder = folder_.Path("gone");
  std::filesystem::create_directory(folder);
  Runner runner = Runner::WithCheckpoint(Plan(), folder + "/unfinished.part", 1);
  std::filesystem::remove_all(folder);
  EXPECT_THROW(runner.Get(ListItems(Plan(), {}), Knit), KeptResultsError);
}

// What could not be read again is not written; what was written before stays, and the message says how much.
TEST_F(RunnerWithCheckpoint, AResultThatIsTooLongIsNotKept) {
  const StopOnSignals stop;
  Run(1, [](int call) {
    if (call == 4) throw InputError("no wool");
  });
  ASSERT_EQ(NumKept(), 3u);
  Runner runner = Runner::WithCheckpoint(Plan(), path_, 1);
  const auto knit_long = [](const ItemPlace& place) {
    if (place.group == 2) std::raise(SIGTERM);
    return place.group == 0 ? Knit(place) : "\"" + std::string(kMaxPieceBytes, 'x') + "\"";
  };
  try {
    runner.Get(ListItems(Plan(), {}), knit_long);
    ADD_FAILURE() << "it was not stopped";
  } catch (const Stopped& stopped) {
    EXPECT_NE(std::string(stopped.what()).find("has 3 of at most 31 rows"), std::string::npos)
        << stopped.what();
  }
  EXPECT_EQ(NumKept(), 3u);
  const StopOnSignals forgets_the_signal;
}

// As the last version wrote it: one JSON object without checksums.
TEST_F(RunnerOfShards, AnEarlierFormatIsRefusedByName) {
  const std::string old =
      folder_.Write("old.json", "{\"format\": \"rcme part 1\", \"work\": \"knitting\", \"pieces\": [\n]}\n");
  EXPECT_TRUE(IsPart(old));
  EXPECT_TRUE(IsRefused({old}, {old, "'rcme part 1', not 'rcme part 2'", "run its shard again"}));
}

// Every byte of a part replaced, one after the other: what is read is what was written, or damage is named.
TEST(PartFile, EveryByteIsProtected) {
  const Part part{"knitting",
                  "wool: red\n",
                  {1, 2},
                  {"rcme 1", "AVX2"},
                  {{{0, 1}, {"[0,7,3,0]", 0.5}}, {{1, 0}, {"[1]", 1.5}}}};
  const std::string text = PartAsText(part, part.results);
  const TempFolder folder;
  const Part read = ReadPart(folder.Write("part", text));
  EXPECT_EQ(PartAsText(read, read.results), text);
  int num_refused = 0;
  for (size_t i = 0; i < text.size(); ++i) {
    for (const int flip : {1, 2, 8, 0x55}) {
      std::string damaged = text;
      damaged[i] = static_cast<char>(damaged[i] ^ flip);
      const std::string path = folder.Write("part", damaged);
      num_refused += ThrowsInputError([&] { ReadPart(path); }, {path});
      if (i <= text.find('\n')) continue;  // of the first line
      const SalvagedPart salvaged = SalvagePart(path);
      EXPECT_FALSE(salvaged.damage.empty()) << i;
      EXPECT_EQ(salvaged.num_lost + salvaged.part.results.size(), 2U) << i;
      for (const auto& [place, result] : salvaged.part.results)
        EXPECT_EQ(result.json, part.results.at(place).json) << i;
    }
  }
  EXPECT_EQ(num_refused, static_cast<int>(4 * text.size()));
}

// What is refused before it fills memory: lines and lists without end.
TEST(PartFile, IsNotFollowedFar) {
  const TempFolder folder;
  const auto is_refused = [&](const std::string& text, const std::string& word) {
    return ThrowsInputError([&] { ReadPart(folder.Write("part", text)); }, {"part", word});
  };
  EXPECT_TRUE(
      is_refused(std::string(kMaxPartLineBytes + 1, 'x'), "1: the line is too long; at most 67108864 bytes"));
  const std::string first = PartAsText({"knitting", "", {1, 1}, {"", ""}, {}}, {});
  EXPECT_TRUE(is_refused(first + "{" + std::string(kMaxPieceBytes, '['),
                         "2: the piece is too long; at most 8388608 bytes"));
  EXPECT_THROW(ParsePiece(std::string(1000, '[') + std::string(1000, ']')), std::invalid_argument);
  EXPECT_NO_THROW(ParsePiece("[[[1]]]"));
}

TEST(PartFile, IsNotWrittenWhereItCouldNotBeReadAgain) {
  const TempFolder folder;
  const std::string path = folder.Path("part");
  const Part part{"knitting", "", {1, 1}, {"", ""}, {}};
  const auto write = [&](size_t size) {
    WritePart(path, part, {{{1, 0}, {"\"" + std::string(size, 'x') + "\"", 0.5}}});
  };
  write(kMaxPieceBytes - 300);
  EXPECT_EQ(ReadPart(path).results.size(), 1u);
  EXPECT_THROW(write(kMaxPieceBytes), PartIsTooLong);
  EXPECT_EQ(ReadPart(path).results.size(), 1u);
}

TEST(PartFile, KeepsEveryNumberToItsLastBit) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double x : {0.1, -0.0, 1e-310, 1.0 / 3.0, infinity, -infinity}) {
    const double back = NumberFrom(Json::parse(NumberAsJson(x).dump()));
    EXPECT_EQ(back, x);
    EXPECT_EQ(std::signbit(back), std::signbit(x));
  }
  for (const double sign : {1.0, -1.0}) {
    const double back = NumberFrom(NumberAsJson(std::copysign(std::nan(""), sign)));
    EXPECT_TRUE(std::isnan(back));
    EXPECT_EQ(std::signbit(back), sign < 0.0);
  }
  EXPECT_THROW(NumberFrom(Json("x")), std::invalid_argument);
}

// A study may be named in any bytes.
TEST(PartFile, HoldsTextThatIsNoUtf8) {
  const TempFolder folder;
  WorkPlan plan = Plan();
  plan.identity =
      "wool: r\xf6"
      "d\n";
  Runner::OfShard(plan, {}, folder.Path("part.json"), 1).Get(ListItems(plan, {}), Knit);
  EXPECT_EQ(MergeParts(plan, {folder.Path("part.json")}).results.size(), 31);
}

}  // namespace
}  // namespace rcme
