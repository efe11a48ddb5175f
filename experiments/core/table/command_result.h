// The result of a command, and the one place where it is rendered in the formats of --format.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "experiments/core/table/table.h"

namespace rcme {

struct CommandResult {
  std::string text = {};  // table: tables and sentences for people
  Table rows = {};        // csv, latex, markdown
  std::string json = {};  // json: a document, one of whose arrays has the same rows
};

// table, csv, json, latex, markdown
const std::vector<std::string>& ListResultFormats();

// `format` is one of these.
std::string RenderResult(const CommandResult& result, const std::string& format);

// What is said of a result as a whole, by key.
using Facts = std::vector<std::pair<std::string, Value>>;

// The rows of a table as an array of a JSON document.
struct NamedTable {
  std::string name;
  Table table;
};

// A JSON document: its format (core/text/json_output.h), the facts, an array for each table.
std::string RenderDocument(const char* format, const Facts& facts, const std::vector<NamedTable>& tables);

// A result that has no more than this: the document's first array is `rows`.
CommandResult MakeResult(const std::string& text, const char* format, const Facts& facts, const Table& rows,
                         const std::vector<NamedTable>& more = {});

}  // namespace rcme
