#include "experiments/real/answer/answer_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

#include "experiments/core/table/render_table.h"
#include "experiments/core/text/json_output.h"
#include "experiments/real/answer/motion_words.h"
#include "stats/constants.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

bool HasMotion(const FileAnswer& file) {
  return file.error.empty() && file.answer.estimate.status == MotionStatus::kOk;
}

// Returns a number of a motion; nothing without a motion.
ColumnOf<FileAnswer> MotionColumn(const Column& column,
                                  const std::function<Value(const MotionEstimate&)>& of) {
  return {column,
          [of](const FileAnswer& file) { return HasMotion(file) ? of(file.answer.estimate) : Value(); }};
}

// The columns of R and t, element by element; JSON has them as lists.
void AddMatrixColumns(std::vector<ColumnOf<FileAnswer>>* columns) {
  const auto column = [](const std::string& name) {
    Column number = Column::Number(name, {1.0, "", ".3g", ".2g", ".17g"});
    number.json_name = kNotInJson;
    return number;
  };
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c)
      columns->push_back(MotionColumn(column(fmt::format("R_{}{}", r, c)),
                                      [=](const MotionEstimate& e) { return e.cam2_from_cam1.R(r, c); }));
  }
  for (int r = 0; r < 3; ++r)
    columns->push_back(MotionColumn(column(fmt::format("t_{}", r)),
                                    [=](const MotionEstimate& e) { return e.cam2_from_cam1.t(r); }));
}

// The failure probabilities for the requested bounds; JSON has them as a list.
void AddBoundColumns(const AnswerTerms& terms, std::vector<ColumnOf<FileAnswer>>* columns) {
  for (size_t i = 0; i < terms.bounds.size(); ++i) {
    Column column =
        Column::Number(fmt::format("failure_probability_{}_{}", terms.bounds[i].max_rotation_error_deg,
                                   terms.bounds[i].max_direction_error_deg));
    column.json_name = kNotInJson;
    columns->push_back({column, [i](const FileAnswer& file) {
                          const auto& found = file.answer.for_bounds;
                          return i < found.size() ? Value(found[i].failure_probability) : Value();
                        }});
  }
}

void AddLevelColumns(const AnswerTerms& terms, std::vector<ColumnOf<FileAnswer>>* columns) {
  if (!terms.integrity_risk) return;
  const auto add = [&](const std::string& name, double ProtectionLevels::*level) {
    columns->push_back({Column::Number(name), [level](const FileAnswer& file) {
                          const auto& protection = file.answer.protection;
                          return protection ? Value(kDegPerRad * (protection->levels.*level)) : Value();
                        }});
  };
  add("rotation_level_deg", &ProtectionLevels::rotation_rad);
  add("direction_level_deg", &ProtectionLevels::direction_rad);
}

// Returns "a" for "pairs/a.csv.gz".
std::string FindPairName(const std::string& path) {
  const std::string name = std::filesystem::path(path).filename().string();
  return name.substr(0, name.find(".csv"));
}

std::string RenderAnswers(const std::vector<FileAnswer>& files, const AnswerTerms& terms) {
  const auto is_read = [](const FileAnswer& file) { return file.error.empty(); };
  const bool has_errors = std::ranges::any_of(files, [&](const FileAnswer& file) {
    return is_read(file) && !std::isnan(file.answer.record.rotation_error_deg);
  });
  const AnswerTableColumns columns{terms.bounds, terms.integrity_risk.has_value(), has_errors};
  Table table;
  for (const std::string& name : ListAnswerColumns(columns)) table.columns.push_back(Column::Text(name));
  table.columns.front().is_key = true;
  for (const FileAnswer& file : files) {
    if (!is_read(file)) continue;
    const std::vector<std::string> row = FormatAnswerRow(FindPairName(file.path), file.answer, columns);
    table.rows.emplace_back(row.begin(), row.end());
  }
  const auto num_motions = std::ranges::count_if(files, HasMotion);
  const bool has_extrapolated = std::ranges::any_of(
      files, [&](const FileAnswer& file) { return is_read(file) && IsExtrapolated(file.answer); });
  return RenderText(table) + "\n" + AnswerLegend(has_errors, terms.integrity_risk, has_extrapolated) +
         fmt::format("{} pairs: {} motions, {} without one, {} not read\n", files.size(), num_motions,
                     std::ssize(table.rows) - num_motions, std::ssize(files) - std::ssize(table.rows));
}

}  // namespace

Json FileAnswerAsJson(const FileAnswer& file, const AnswerTerms& terms) {
  if (!file.error.empty())
    return {{"status", StatusName(MotionStatus::kInvalidInput)}, {"message", file.error}};
  Json json = AnswerAsJson(file.answer, terms.spec);
  for (const InputDoubt& doubt : file.doubts)
    json["warnings"].push_back(fmt::format("{}: {}", doubt.place, doubt.what));
  return json;
}

Table MakeFileAnswerTable(const std::vector<FileAnswer>& files, const AnswerTerms& terms) {
  const auto of_read = [](const std::function<Value(const PairAnswer&)>& value) {
    return [value](const FileAnswer& file) { return file.error.empty() ? value(file.answer) : Value(); };
  };
  std::vector<ColumnOf<FileAnswer>> columns = {
      {Column::Key("file"), [](const FileAnswer& file) { return file.path; }},
      {Column::Text("status"),
       [](const FileAnswer& file) {
         return StatusName(file.error.empty() ? file.answer.estimate.status : MotionStatus::kInvalidInput);
       }},
      {Column::Count("num_matches"), of_read([](const PairAnswer& a) { return a.record.num_matches; })},
      {Column::Count("num_inliers"), of_read([](const PairAnswer& a) { return a.record.num_inliers; })},
      MotionColumn(Column::Number("turned_deg"),
                   [](const MotionEstimate& e) { return ComputeTurn(e.cam2_from_cam1.R).angle_deg; }),
      MotionColumn(
          Column::Number("turned_sd_deg"),
          [](const MotionEstimate& e) { return ComputeSpread(e.cam2_from_cam1, e.pose_cov).angle_sd_deg; }),
      MotionColumn(Column::Number("direction_sd_deg"),
                   [](const MotionEstimate& e) {
                     return ComputeSpread(e.cam2_from_cam1, e.pose_cov).direction_sd_deg(0);
                   }),
      MotionColumn(Column::Number("failure_probability"),
                   [](const MotionEstimate& e) {
                     return std::isnan(e.failure_probability) ? Value() : Value(e.failure_probability);
                   }),
      MotionColumn(Column::Text("failure_probability_domain"), [](const MotionEstimate& e) {
        return std::isnan(e.failure_probability) ? Value() : Value(Name(e.probability_domain));
      })};
  AddBoundColumns(terms, &columns);
  AddLevelColumns(terms, &columns);
  const auto add_error = [&](const std::string& name, double TrialRecord::*error) {
    columns.push_back({Column::Number(name), of_read([error](const PairAnswer& a) {
                         return std::isnan(a.record.*error) ? Value() : Value(a.record.*error);
                       })});
  };
  add_error("rotation_error_deg", &TrialRecord::rotation_error_deg);
  add_error("direction_error_deg", &TrialRecord::direction_error_deg);
  add_error("nees", &TrialRecord::nees);
  AddMatrixColumns(&columns);
  columns.push_back({Column::Text("message"), [](const FileAnswer& file) {
                       return file.error.empty() ? file.answer.estimate.message : file.error;
                     }});
  return MakeTable(columns, files);
}

CommandResult MakeAnswersResult(const std::vector<FileAnswer>& files, const AnswerTerms& terms) {
  const Table table = MakeFileAnswerTable(files, terms);
  Json rows = RenderJson(table);
  for (size_t i = 0; i < files.size(); ++i) rows[i].update(FileAnswerAsJson(files[i], terms));
  return {RenderAnswers(files, terms), table,
          JsonText(kEstimatesFormat, {{"estimator", terms.spec.label}, {"rows", rows}})};
}

}  // namespace rcme
