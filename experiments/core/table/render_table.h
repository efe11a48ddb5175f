// Renders a Table as text, with one function per format.
#pragma once

#include <algorithm>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "experiments/core/table/table.h"
#include "experiments/core/text/columns.h"

namespace rcme {

// For a terminal: text to the left, counts to the right; a text of more than half of `width` (of the
// only column beside the keys: all), or of more than the keys leave of it, goes on in the next line. Columns
// that do not fit follow in further blocks, each after the key columns and without the rows that have nothing
// there; a block without any row is left out. Only a column that does not fit beside the keys is wider than
// `width`. Line ends within a cell become spaces. "12.34 % [10.10, 14.80] (n 12): a note", "1.23 +- 0.04";
// "-": not known.
std::string RenderText(const Table& table, size_t width = kTextWidth);

// A cell of RenderText.
std::string FormatEstimate(const Estimate& estimate, const NumberFormat& format);

// RFC 4180 but for line ends, which are "\n". Texts are fields of field_text.h; what
// is not known is empty, as are infinite ends of an interval. An estimate is its value alone.
std::string RenderCsv(const Table& table);
// Its parts: that of all rows is the heading and the rows of any division of them.
std::string RenderCsvHeading(const Table& table);
std::string RenderCsvRows(const Table& table);
// RenderCsv(MakeTable(columns, items)) without a table of all items: its values take ten times as much memory
// as their text.
template <typename Item>
std::string RenderCsv(const std::vector<ColumnOf<Item>>& columns, const std::vector<Item>& items) {
  constexpr size_t kNumTogether = 1000;
  std::string text = RenderCsvHeading(MakeTable(columns, std::vector<Item>()));
  for (size_t begin = 0; begin < items.size(); begin += kNumTogether) {
    const size_t size = std::min(kNumTogether, items.size() - begin);
    text += RenderCsvRows(MakeTable(columns, std::span(items).subspan(begin, size)));
  }
  return text;
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
