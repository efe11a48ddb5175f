#include "experiments/real/truth_check/truth_check_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>

#include "experiments/core/table/render_table.h"
#include "experiments/core/text/columns.h"
#include "experiments/core/text/json_output.h"

namespace rcme {
namespace {

struct SceneCount {
  std::string scene;
  std::int64_t pairs = 0, in_doubt = 0, holds = 0, silent = 0, no_truth = 0;
};

std::vector<SceneCount> CountScenes(const std::vector<CheckedPair>& pairs) {
  std::map<std::string, SceneCount> scenes;
  for (const CheckedPair& pair : pairs) {
    SceneCount& count = scenes[pair.scene];
    count.scene = pair.scene;
    ++count.pairs;
    count.no_truth += !pair.has_truth;
    count.in_doubt += pair.verdict.verdict == TruthVerdict::kInDoubt;
    count.holds += pair.verdict.verdict == TruthVerdict::kHolds;
    count.silent += pair.has_truth && pair.verdict.verdict == TruthVerdict::kSilent;
  }
  std::vector<SceneCount> counts;
  for (const auto& [scene, count] : scenes) counts.push_back(count);
  return counts;
}

Table MakeSceneTable(const std::vector<SceneCount>& counts) {
  using C = const SceneCount&;
  const std::vector<ColumnOf<SceneCount>> columns = {
      {Column::Key("scene"), [](C c) { return c.scene; }},
      {Column::Count("pairs"), [](C c) { return c.pairs; }},
      {Column::Count("in_doubt"), [](C c) { return c.in_doubt; }},
      {Column::Count("holds"), [](C c) { return c.holds; }},
      {Column::Count("silent"), [](C c) { return c.silent; }},
      {Column::Count("no_truth"), [](C c) { return c.no_truth; }}};
  return MakeTable(columns, counts);
}

struct EvidenceRow {
  const CheckedPair* pair;
  const FrontEndEvidence* evidence;
};

std::vector<EvidenceRow> ListEvidence(const std::vector<CheckedPair>& pairs, bool only_in_doubt) {
  std::vector<EvidenceRow> rows;
  for (const CheckedPair& pair : pairs) {
    if (only_in_doubt && pair.verdict.verdict != TruthVerdict::kInDoubt) continue;
    for (const FrontEndEvidence& evidence : pair.front_ends) rows.push_back({&pair, &evidence});
  }
  return rows;
}

Table MakeEvidenceTable(const std::vector<EvidenceRow>& rows) {
  using R = const EvidenceRow&;
  const NumberFormat degrees{1.0, "", ".1f", ".2g", ".8g"};
  const auto count = [](const char* name, const char* heading, std::int64_t TruthContest::*field) {
    return ColumnOf<EvidenceRow>{{.name = name, .type = ColumnType::kCount, .heading = heading},
                                 [field](R row) { return row.evidence->counts.*field; }};
  };
  const auto blocks = [](const char* name, const char* heading, int TruthContest::*field) {
    return ColumnOf<EvidenceRow>{{.name = name, .type = ColumnType::kCount, .heading = heading},
                                 [field](R row) { return std::int64_t{row.evidence->counts.*field}; }};
  };
  const std::vector<ColumnOf<EvidenceRow>> columns = {
      {Column::Key("scene"), [](R row) { return row.pair->scene; }},
      {Column::Key("pair_id"), [](R row) { return row.pair->pair_id; }},
      {Column::Key("front_end"), [](R row) { return row.evidence->front_end; }},
      {{.name = "pair_verdict", .heading = "pair"}, [](R row) { return Name(row.pair->verdict.verdict); }},
      {{.name = "verdict", .heading = "front end says"}, [](R row) { return Name(row.evidence->verdict); }},
      count("matches", "matches", &TruthContest::num_matches),
      count("by_truth", "by truth", &TruthContest::by_truth),
      count("by_motion", "by motion", &TruthContest::by_motion),
      count("by_truth_only", "truth only", &TruthContest::by_truth_only),
      count("by_motion_only", "motion only", &TruthContest::by_motion_only),
      blocks("blocks_of_truth", "blocks: truth", &TruthContest::blocks_of_truth),
      blocks("blocks_of_motion", "motion", &TruthContest::blocks_of_motion),
      {Column::Number("p_value", {1.0, "", ".1e"}), [](R row) { return row.evidence->p_value; }},
      {{.name = "rotation_error_deg", .type = ColumnType::kNumber, .format = degrees, .heading = "R deg"},
       [](R row) { return row.evidence->rotation_error_deg; }},
      {{.name = "direction_error_deg", .type = ColumnType::kNumber, .format = degrees, .heading = "t deg"},
       [](R row) { return row.evidence->direction_error_deg; }}};
  return MakeTable(columns, rows);
}

std::string DescribeSum(const std::vector<CheckedPair>& pairs) {
  SceneCount sum;
  for (const SceneCount& count : CountScenes(pairs)) {
    sum.pairs += count.pairs;
    sum.in_doubt += count.in_doubt;
    sum.silent += count.silent;
    sum.no_truth += count.no_truth;
  }
  return FormatParagraph(fmt::format(
      "The truth of {} of {} pairs is in doubt; of {} the matches say too little, and {} have none.",
      sum.in_doubt, sum.pairs, sum.silent, sum.no_truth));
}

std::string TruthCheckAsText(const std::vector<CheckedPair>& pairs, const TruthCheckOptions& options) {
  std::string text = DescribeSum(pairs) + "\n" + RenderText(MakeSceneTable(CountScenes(pairs)));
  const std::vector<EvidenceRow> in_doubt = ListEvidence(pairs, true);
  if (!in_doubt.empty()) text += "\n" + RenderText(MakeEvidenceTable(in_doubt));
  return text + "\n" +
         FormatParagraph(fmt::format(
             "In doubt: a motion beyond {:g} deg in rotation or {:g} deg in direction, found in one half of "
             "the matches, explains the other half better than the truth, moved as far as it may be off: of "
             "the matches, and of the blocks of the image, that tell the two apart, more than a coin gives "
             "(in both halves p <= {:g} over the number of front ends), and with no front end the matches "
             "speak for the truth. by truth, by motion: matches explained, of both halves together; one of "
             "each key point counts. R, t: errors of the motion of all matches against the truth.",
             options.bounds.max_rotation_error_deg, options.bounds.max_direction_error_deg,
             kTruthDoubtLevel));
}

}  // namespace

std::string TruthDoubtsAsCsv(const std::vector<CheckedPair>& pairs) {
  std::vector<CheckedPair> in_doubt;
  std::ranges::copy_if(pairs, std::back_inserter(in_doubt), [](const CheckedPair& pair) {
    return pair.verdict.verdict == TruthVerdict::kInDoubt;
  });
  using P = const CheckedPair&;
  const std::vector<ColumnOf<CheckedPair>> columns = {
      {Column::Key("scene"), [](P pair) { return pair.scene; }},
      {Column::Key("pair_id"), [](P pair) { return pair.pair_id; }},
      {Column::Number("p_value"), [](P pair) { return pair.verdict.p_value; }}};
  return RenderCsv(MakeTable(columns, in_doubt));
}

CommandResult MakeTruthCheckResult(const std::vector<CheckedPair>& pairs, const TruthCheckOptions& options) {
  const Table evidence = MakeEvidenceTable(ListEvidence(pairs, false));
  return {TruthCheckAsText(pairs, options), evidence,
          RenderDocument(kTruthCheckFormat,
                         {{"max_rotation_error_deg", options.bounds.max_rotation_error_deg},
                          {"max_direction_error_deg", options.bounds.max_direction_error_deg},
                          {"level", kTruthDoubtLevel}},
                         {{"scenes", MakeSceneTable(CountScenes(pairs))}, {"evidence", evidence}})};
}

}  // namespace rcme
