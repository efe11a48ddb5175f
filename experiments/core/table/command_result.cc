#include "experiments/core/table/command_result.h"

#include <nlohmann/json.hpp>

#include "experiments/core/table/render_table.h"
#include "experiments/core/text/json_output.h"

namespace rcme {

const std::vector<std::string>& ListResultFormats() {
  static const std::vector<std::string> kFormats = {"table", "csv", "json", "latex", "markdown"};
  return kFormats;
}

std::string RenderResult(const CommandResult& result, const std::string& format) {
  if (format == "csv") return RenderCsv(result.rows);
  if (format == "json") return result.json;
  const Table& printed = result.paper.columns.empty() ? result.rows : result.paper;
  if (format == "latex") return RenderLatex(printed);
  if (format == "markdown") return RenderMarkdown(printed);
  return result.text;
}

std::string RenderDocument(const char* format, const Facts& facts, const std::vector<NamedTable>& tables) {
  nlohmann::ordered_json document = nlohmann::ordered_json::object();
  Table table{{}, {{}}};
  for (const auto& [key, value] : facts) {
    table.columns.push_back({.name = key, .json_name = key});
    table.rows.front().push_back(value);
  }
  document.update(RenderJson(table).front());
  for (const NamedTable& each : tables) document[each.name] = RenderJson(each.table);
  return JsonText(format, document);
}

CommandResult MakeResult(const std::string& text, const char* format, const Facts& facts, const Table& rows,
                         const std::vector<NamedTable>& more) {
  std::vector<NamedTable> tables = {{"rows", rows}};
  tables.insert(tables.end(), more.begin(), more.end());
  return {.text = text, .rows = rows, .json = RenderDocument(format, facts, tables)};
}

}  // namespace rcme
