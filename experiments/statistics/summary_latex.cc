#include "experiments/statistics/summary_latex.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "experiments/statistics/summary_output.h"
#include "experiments/core/text/field_text.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"

namespace rcme {
namespace {

using Kind = SummaryRow::Kind;

// The names of a table in words, and which of the labels were needed.
class Names {
 public:
  explicit Names(const Settings& labels) : labels_(labels.begin(), labels.end()) {}

  // Escaped; without a label as `otherwise` says.
  std::string Of(const std::string& name, const std::string& otherwise) {
    known_.insert(name);
    const auto label = labels_.find(name);
    return LatexText(label == labels_.end() ? otherwise : label->second);
  }

  std::string Of(const std::string& name) { return Of(name, name); }

  std::string InWords(const std::string& name) {
    std::string words = name;
    std::ranges::replace(words, '_', ' ');
    return Of(name, words);
  }

  void CheckAllWereNeeded() const {
    for (const auto& [name, label] : labels_) {
      if (!known_.contains(name))
        throw InputError(fmt::format("--labels: {} is no name in the table; allowed: {}", Quoted(name),
                                     fmt::join(known_, ", ")));
    }
  }

 private:
  std::map<std::string, std::string> labels_;
  std::set<std::string> known_;
};

bool IsInPerCent(Kind kind) { return kind == Kind::kRate || kind == Kind::kScore || kind == Kind::kShare; }

// A number with a minus sign, not a hyphen.
std::string Number(const std::string& digits) {
  if (digits == "inf" || digits == "-inf") return digits == "inf" ? "$\\infty$" : "$-\\infty$";
  return digits.starts_with('-') ? "$-$" + digits.substr(1) : digits;
}

std::string PerCent(double share) { return Number(fmt::format("{:.2f}", 100.0 * share)); }

std::string Digits(double value) { return Number(fmt::format("{:.3g}", value)); }

// "12.34 [10.10, 14.80]", "1.23 $\pm$ 0.04"; a dash where there are no trials.
std::string CellOf(const SummaryRow& row, std::int64_t num_trials) {
  if (row.n == 0) return "--";
  std::string text = IsInPerCent(row.kind) ? PerCent(row.value) : Digits(row.value);
  if (row.kind == Kind::kMean) {
    if (!std::isnan(row.standard_error)) text += fmt::format(" $\\pm$ {:.2g}", row.standard_error);
  } else if (std::isfinite(row.interval.lower) && std::isfinite(row.interval.upper)) {
    const auto in_words = IsInPerCent(row.kind) ? PerCent : Digits;
    text += fmt::format(" [{}, {}]", in_words(row.interval.lower), in_words(row.interval.upper));
  }
  return row.n == num_trials ? text : text + fmt::format(" ($n = {}$)", row.n);
}

// One line of the table.
struct Line {
  const SummaryRow* first = nullptr;
  std::int64_t num_trials = 0;
  std::map<std::string, const SummaryRow*> of;  // by quantity
};

std::vector<Line> LinesOf(const Summary& summary) {
  std::vector<Line> lines;
  for (const SummaryRow& row : summary.rows) {
    if (row.estimator == kSceneLabel) continue;
    if (row.quantity == "not_scored") lines.push_back({&row, row.n, {}});  // the first of each
    if (!lines.empty()) lines.back().of[row.quantity] = &row;
  }
  return lines;
}

Kind KindOf(const Summary& summary, const std::string& quantity) {
  std::set<std::string> known;
  for (const SummaryRow& row : summary.rows) {
    if (row.estimator == kSceneLabel) continue;
    if (row.quantity == quantity) return row.kind;
    known.insert(row.quantity);
  }
  throw InputError(fmt::format("--quantities: {} is no quantity of an estimator in this summary; allowed: {}",
                               Quoted(quantity), fmt::join(known, ", ")));
}

std::string HeadOf(const Summary& summary, const std::vector<std::string>& quantities, Names* names) {
  std::vector<std::string> cells;
  for (const std::string& factor : summary.factor_names) cells.push_back(names->InWords(factor));
  cells.insert(cells.end(), {"estimator", "$n$"});
  for (const std::string& quantity : quantities)
    cells.push_back(names->InWords(quantity) + (IsInPerCent(KindOf(summary, quantity)) ? " (\\%)" : ""));
  return fmt::format("{} \\\\\n", fmt::join(cells, " & "));
}

// The levels only where a condition begins.
std::string LineAsText(const Line& line, bool is_first, const std::vector<std::string>& quantities,
                       Names* names) {
  std::vector<std::string> cells;
  for (const std::string& level : line.first->levels) cells.push_back(is_first ? LatexText(level) : "");
  cells.push_back(names->Of(line.first->estimator));
  cells.push_back(fmt::format("{}", line.num_trials));
  for (const std::string& quantity : quantities) {
    const auto row = line.of.find(quantity);
    cells.push_back(row == line.of.end() ? "--" : CellOf(*row->second, line.num_trials));
  }
  return fmt::format("{} \\\\\n", fmt::join(cells, " & "));
}

}  // namespace

const std::vector<std::string>& DefaultLatexQuantities() {
  static const std::vector<std::string> quantities = {"failure", "failure_or_refusal", "nees_coverage",
                                                      "auc_10_deg"};
  return quantities;
}

std::string SummaryAsLatex(const Summary& summary, const std::vector<std::string>& quantities,
                           const Settings& labels) {
  Names names(labels);
  const std::string head = HeadOf(summary, quantities, &names);
  std::string body;
  const std::vector<Line> lines = LinesOf(summary);
  for (size_t i = 0; i < lines.size(); ++i) {
    const bool is_first = i == 0 || lines[i].first->condition != lines[i - 1].first->condition;
    if (is_first && i > 0) body += "\\addlinespace\n";
    body += LineAsText(lines[i], is_first, quantities, &names);
  }
  names.CheckAllWereNeeded();
  return fmt::format(
      "% Study {}: {} of {} trials done. Rates with {} intervals, scores with {} ones, medians with\n"
      "% distribution-free 95 % ones, means with Monte-Carlo standard errors; (n = ...) where it is not the "
      "row's.\n"
      "% Needs \\usepackage{{booktabs}}.\n"
      "\\begin{{tabular}}{{{}}}\n\\toprule\n{}\\midrule\n{}\\bottomrule\n\\end{{tabular}}\n",
      LatexText(summary.study), summary.num_trials_done, summary.num_trials_planned, IntervalKindsIn(summary),
      IntervalKindInWords(IntervalKind::kBetting),
      std::string(summary.factor_names.size() + 1, 'l') + "r" + std::string(quantities.size(), 'r'), head,
      body);
}

}  // namespace rcme
