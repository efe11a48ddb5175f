// Renders a Table as text, with one function per format.
#pragma once

#include <algorithm>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "experiments/core/table/table.h"
#include "experiments/core/text/columns.h"
#include "experiments/core/text/write_text.h"

namespace rcme {

// Renders a table for a terminal. Texts are aligned left, counts right. An estimate looks like "12.34 %
// [10.10, 14.80] (n 12): a note" or "1.23 +- 0.04"; "-" means not known. Line ends within a cell become
// spaces.
//
// Text columns are broken into several lines at half of `width`, or at the width that the key columns leave;
// a text column that is the only one beside the keys gets all of that. Columns that do not fit follow in
// further blocks, which repeat the key columns and omit rows without a value in the block; a block without
// rows is omitted. Levels that the first one determines are left out if the keys take more than half of
// `width`; a last line says how many. The result is wider than `width` only if a single column does not fit
// beside the keys.
std::string RenderText(const Table& table, size_t width = kTextWidth);

// The texts of a table's cells: the headings, then each row.
using Cells = std::vector<std::vector<std::string>>;
void AppendCells(const Table& rows, Cells* cells);
std::string RenderCells(std::vector<Column> columns, Cells cells, size_t width = kTextWidth);

// Makes a table from 1000 items at a time and visits it. The values of a whole large table would take
// several times as much memory as their texts.
template <typename Item, typename Visit>
void ForEachPart(const std::vector<ColumnOf<Item>>& columns, const std::vector<Item>& items, Visit visit) {
  constexpr size_t kNumTogether = 1000;
  for (size_t begin = 0; begin < items.size(); begin += kNumTogether) {
    const size_t size = std::min(kNumTogether, items.size() - begin);
    visit(MakeTable(columns, std::span(items).subspan(begin, size)));
  }
}

// RenderText(MakeTable(columns, items)).
template <typename Item>
std::string RenderText(const std::vector<ColumnOf<Item>>& columns, const std::vector<Item>& items) {
  const Table heading = MakeTable(columns, std::vector<Item>());
  Cells cells;
  cells.reserve(1 + items.size());
  AppendCells(heading, &cells);
  ForEachPart(columns, items, [&](const Table& rows) { AppendCells(rows, &cells); });
  return RenderCells(heading.columns, std::move(cells));
}

// Formats an estimate as in a cell of RenderText.
std::string FormatEstimate(const Estimate& estimate, const NumberFormat& format);

// Renders CSV as in RFC 4180, but with "\n" as line end. Texts are fields of field_text.h. Unknown values
// and infinite interval ends are empty. An estimate is written as its value alone.
std::string RenderCsv(const Table& table);
// The parts of RenderCsv: the heading, followed by the rows in any number of parts.
std::string RenderCsvHeading(const Table& table);
std::string RenderCsvRows(const Table& table);
// RenderCsv(MakeTable(columns, items)), given to `write` piece by piece.
template <typename Item>
void WriteCsv(const std::vector<ColumnOf<Item>>& columns, const std::vector<Item>& items,
              const WriteText& write) {
  write(RenderCsvHeading(MakeTable(columns, std::vector<Item>())));
  ForEachPart(columns, items, [&](const Table& rows) { write(RenderCsvRows(rows)); });
}

// Renders an array with an object per row. Numbers have all digits; null means not known or infinite. An
// interval is a list of its two ends.
nlohmann::ordered_json RenderJson(const Table& table);
// Renders an estimate that is not in a table: value, interval as a list of its ends, and n if it is set.
nlohmann::ordered_json RenderJson(const Estimate& estimate);
nlohmann::ordered_json RenderJson(const Interval& interval);
// {"value", "lower", "upper"}.
nlohmann::ordered_json RenderJsonBounds(const Estimate& estimate);

// Renders a LaTeX tabular with the rules of the package booktabs; all texts are escaped. The columns of the
// group `levels` are printed only in rows where one of them changes, with extra space above.
std::string RenderLatex(const Table& table);

// Renders a Markdown table with the cells of RenderText. Line ends within a cell become spaces.
std::string RenderMarkdown(const Table& table);

}  // namespace rcme
