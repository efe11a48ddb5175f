// The result of a command. RenderResult is the only place that renders it in the formats of --format.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "experiments/core/table/table.h"

namespace rcme {

struct CommandResult {
  std::string text = {};  // format table: tables and sentences for people
  Table rows = {};        // format csv
  std::string json = {};  // format json: a document; one of its arrays has the same rows
  Table paper = {};       // formats latex and markdown, for a page; without columns: the rows
};

// Returns table, csv, json, latex, markdown.
const std::vector<std::string>& ListResultFormats();

// Renders `result` in one of these formats.
std::string RenderResult(const CommandResult& result, const std::string& format);

// Values that describe a result as a whole, by key.
using Facts = std::vector<std::pair<std::string, Value>>;

// A table that becomes an array of a JSON document.
struct NamedTable {
  std::string name;
  Table table;
};

// Renders a JSON document: its format (core/text/json_output.h), the facts, and an array for each table.
std::string RenderDocument(const char* format, const Facts& facts, const std::vector<NamedTable>& tables);

// Makes a result whose JSON document has the facts, the array `rows`, and the arrays `more`.
CommandResult MakeResult(const std::string& text, const char* format, const Facts& facts, const Table& rows,
                         const std::vector<NamedTable>& more = {});

}  // namespace rcme
