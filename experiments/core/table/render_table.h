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

// For a terminal: text to the left, counts to the right; a text of more than half of `width` (of the
// only column beside the keys: all), or of more than the keys leave of it, goes on in the next line. Columns
// that do not fit follow in further blocks, each after the key columns and without the rows that have nothing
// there; a block without any row is left out. Only a column that does not fit beside the keys is wider than
// `width`. Line ends within a cell become spaces. "12.34 % [10.10, 14.80] (n 12): a note", "1.23 +- 0.04";
// "-": not known.
std::string RenderText(const Table& table, size_t width = kTextWidth);

// The texts of a table's cells, of the headings, then of each row.
using Cells = std::vector<std::vector<std::string>>;
void AppendCells(const Table& rows, Cells* cells);
std::string RenderCells(const std::vector<Column>& columns, Cells cells, size_t width = kTextWidth);

// A table of some of the items after the other: all values of a large table take several times as much memory
// as their texts.
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

// A cell of RenderText.
std::string FormatEstimate(const Estimate& estimate, const NumberFormat& format);

// RFC 4180 but for line ends, which are "\n". Texts are fields of field_text.h; what
// is not known is empty, as are infinite ends of an interval. An estimate is its value alone.
std::string RenderCsv(const Table& table);
// Its parts: that of all rows is the heading and the rows of any division of them.
std::string RenderCsvHeading(const Table& table);
std::string RenderCsvRows(const Table& table);
// RenderCsv(MakeTable(columns, items)), given to `write` piece by piece.
template <typename Item>
void WriteCsv(const std::vector<ColumnOf<Item>>& columns, const std::vector<Item>& items,
              const WriteText& write) {
  write(RenderCsvHeading(MakeTable(columns, std::vector<Item>())));
  ForEachPart(columns, items, [&](const Table& rows) { write(RenderCsvRows(rows)); });
}

// An array with an object per row. Numbers have all digits; null: not known, or infinite. An interval is a
// list of its ends.
nlohmann::ordered_json RenderJson(const Table& table);
// One estimate outside of a table: value, interval, and n where it has one; an interval is a list of its
// ends.
nlohmann::ordered_json RenderJson(const Estimate& estimate);
nlohmann::ordered_json RenderJson(const Interval& interval);
// {"value", "lower", "upper"}.
nlohmann::ordered_json RenderJsonBounds(const Estimate& estimate);

// A tabular with the rules of the package booktabs, in which every text is escaped. The columns of the group
// `levels` are printed only where one of them changes, with space between. Notes are left out.
std::string RenderLatex(const Table& table);

// A table of Markdown with the cells of RenderText. Line ends within a cell become spaces.
std::string RenderMarkdown(const Table& table);

}  // namespace rcme
