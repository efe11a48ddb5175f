#include "experiments/statistics/summary_latex.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "experiments/core/table/render_table.h"
#include "experiments/core/text/field_text.h"
#include "experiments/statistics/quantity_table.h"
#include "experiments/statistics/summary_output.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"

namespace rcme {
namespace {

// The texts for the names in a table; records which labels were used.
class Names {
 public:
  explicit Names(const Settings& labels) : labels_(labels.begin(), labels.end()) {}

  // Returns `otherwise` for a name without a label.
  std::string Of(const std::string& name, const std::string& otherwise) {
    known_.insert(name);
    const auto label = labels_.find(name);
    return label == labels_.end() ? otherwise : label->second;
  }

  std::string Of(const std::string& name) { return Of(name, name); }

  std::string DescribeName(const std::string& name) {
    std::string words = name;
    std::ranges::replace(words, '_', ' ');
    return Of(name, words);
  }

  void CheckAllWereNeeded() const {
    for (const auto& [name, label] : labels_) {
      if (!known_.contains(name))
        throw InputError(fmt::format("--labels: {} is not a name in the table; allowed: {}", Quoted(name),
                                     fmt::join(known_, ", ")));
    }
  }

 private:
  std::map<std::string, std::string> labels_;
  std::set<std::string> known_;
};

// Replaces the names of factors, estimators and quantities by their labels.
void Rename(Names* names, Table* table) {
  for (size_t c = 0; c < table->columns.size(); ++c) {
    Column& column = table->columns[c];
    if (column.is_symbol) continue;
    if (column.type != ColumnType::kText || column.group == "levels") {
      column.heading = names->DescribeName(column.name);
      continue;
    }
    for (std::vector<Value>& row : table->rows) row[c] = names->Of(std::get<std::string>(row[c]));
  }
}

// Leaves of a note what stands before the first comma: a page shows the verdict, not how many trials would
// decide.
void ShortenNotes(Table* table) {
  for (std::vector<Value>& row : table->rows) {
    for (Value& value : row) {
      if (auto* estimate = std::get_if<Estimate>(&value))
        estimate->note = estimate->note.substr(0, estimate->note.find(','));
    }
  }
}

}  // namespace

const std::vector<std::string>& DefaultLatexQuantities() {
  static const std::vector<std::string> quantities = {"failure", "failure_or_refusal", "nees_coverage",
                                                      "auc_10_deg"};
  return quantities;
}

std::string SummaryAsLatex(const Summary& summary, const std::vector<std::string>& quantities,
                           const Settings& labels) {
  CheckAreQuantities(summary, quantities);
  Names names(labels);
  Table table = MakeQuantityTable(summary, quantities);
  Rename(&names, &table);
  ShortenNotes(&table);
  names.CheckAllWereNeeded();
  return fmt::format(
      "% Study {}: {} of {} trials done. Rates with {} intervals, scores with {} ones, medians with\n"
      "% distribution-free 95 % ones, means with Monte-Carlo standard errors; (n = ...) where it is not the "
      "row's; covers: the whole interval is within 95 +- 1 %.\n"
      "% Needs \\usepackage{{booktabs}}.\n{}",
      LatexText(summary.study), summary.num_trials_done, summary.num_trials_planned, IntervalKindsIn(summary),
      DescribeIntervalKind(IntervalKind::kBetting), RenderLatex(table));
}

}  // namespace rcme
