#include "experiments/real/paper_table/printed_table.h"

#include <algorithm>
#include <array>

#include "stats/paired.h"

namespace rcme {
namespace {

struct PrintedDataset {
  const char* name;
  bool is_indoor;
  int num_pairs;
  int rcme_detect_fail, rcme_failure, prcme_detect_fail, prcme_failure, standard_failure;
};

constexpr std::array<PrintedDataset, 23> kDatasets = {{
    {"KITTI/00", false, 2412, 0, 0, 0, 0, 0},   {"KITTI/01", false, 56, 0, 0, 0, 0, 1},
    {"KITTI/02", false, 2031, 0, 0, 0, 1, 1},   {"KITTI/03", false, 358, 0, 0, 0, 0, 0},
    {"KITTI/04", false, 86, 0, 0, 0, 0, 0},     {"KITTI/05", false, 1489, 0, 0, 0, 0, 4},
    {"KITTI/06", false, 295, 0, 0, 0, 0, 0},    {"KITTI/07", false, 564, 0, 0, 0, 0, 0},
    {"KITTI/08", false, 1690, 0, 0, 0, 0, 3},   {"KITTI/09", false, 678, 0, 0, 0, 1, 0},
    {"KITTI/10", false, 419, 0, 0, 0, 0, 1},    {"EuRoC/MH_01", true, 515, 1, 0, 0, 1, 1},
    {"EuRoC/MH_02", true, 450, 0, 0, 0, 0, 4},  {"EuRoC/MH_03", true, 587, 0, 0, 0, 0, 0},
    {"EuRoC/MH_04", true, 357, 1, 0, 1, 0, 3},  {"EuRoC/MH_05", true, 393, 1, 0, 0, 0, 1},
    {"EuRoC/V1_01", true, 566, 0, 0, 0, 0, 10}, {"EuRoC/V1_02", true, 383, 1, 0, 1, 0, 7},
    {"EuRoC/V1_03", true, 108, 1, 0, 1, 0, 9},  {"EuRoC/V2_01", true, 391, 1, 0, 1, 1, 11},
    {"EuRoC/V2_02", true, 590, 0, 1, 0, 1, 18}, {"EuRoC/V2_03", true, 92, 0, 0, 0, 0, 3},
    {"HRBB4th", true, 306, 0, 0, 0, 0, 1},
}};

struct PrintedColumn {
  const char* method;
  const char* quantity;
  int PrintedDataset::*count;
};
constexpr std::array<PrintedColumn, 5> kColumns = {{
    {"RCME", "detect_fail", &PrintedDataset::rcme_detect_fail},
    {"RCME", "failure", &PrintedDataset::rcme_failure},
    {"pRCME", "detect_fail", &PrintedDataset::prcme_detect_fail},
    {"pRCME", "failure", &PrintedDataset::prcme_failure},
    {"Standard", "failure", &PrintedDataset::standard_failure},
}};

int SumOver(bool is_indoor, int PrintedDataset::*count) {
  int sum = 0;
  for (const PrintedDataset& dataset : kDatasets) sum += dataset.is_indoor == is_indoor ? dataset.*count : 0;
  return sum;
}

double ComputeMcNemar(int first_only, int second_only) {
  PairedCounts counts;
  counts.first_only = first_only;
  counts.second_only = second_only;
  return McNemarExactPValue(counts);
}

}  // namespace

std::vector<PrintedRate> PrintedRates() {
  std::vector<PrintedRate> rates;
  const auto add = [&rates](const std::string& row, const PrintedColumn& column, int count, int n) {
    rates.push_back({row, column.method, column.quantity, count, n, ExactBinomialInterval(count, n)});
  };
  for (const PrintedDataset& dataset : kDatasets) {
    for (const PrintedColumn& column : kColumns)
      add(dataset.name, column, dataset.*column.count, dataset.num_pairs);
  }
  for (const bool is_indoor : {true, false}) {
    for (const PrintedColumn& column : kColumns) {
      add(is_indoor ? "indoor" : "outdoor", column, SumOver(is_indoor, column.count),
          SumOver(is_indoor, &PrintedDataset::num_pairs));
    }
  }
  return rates;
}

std::vector<PrintedComparison> PrintedComparisons() {
  std::vector<PrintedComparison> comparisons;
  for (const bool is_indoor : {true, false}) {
    for (const PrintedColumn& other : {kColumns[3], kColumns[4]}) {
      PrintedComparison c{is_indoor ? "indoor" : "outdoor",
                          "RCME",
                          other.method,
                          SumOver(is_indoor, &PrintedDataset::rcme_failure),
                          SumOver(is_indoor, other.count),
                          SumOver(is_indoor, &PrintedDataset::num_pairs)};
      const int common = std::min(c.first_failures, c.second_failures);
      const double of_many_common = ComputeMcNemar(c.first_failures - common, c.second_failures - common),
                   of_none_common = ComputeMcNemar(c.first_failures, c.second_failures);
      c.least_p = std::min(of_many_common, of_none_common);
      c.greatest_p = std::max(of_many_common, of_none_common);
      comparisons.push_back(c);
    }
  }
  return comparisons;
}

}  // namespace rcme
