#include "experiments/statistics/error_ranking.h"

#include <algorithm>
#include <cmath>

#include "stats/constants.h"

namespace rcme {
namespace {

void AddIfKnown(double stated_deg, double error_deg, std::int64_t cluster, std::vector<StatedError>* errors) {
  if (std::isfinite(stated_deg) && std::isfinite(error_deg))
    errors->push_back({stated_deg, error_deg, cluster});
}

void KeepEverySecond(std::vector<StatedError>* errors) {
  for (size_t i = 0; 2 * i < errors->size(); ++i) (*errors)[i] = (*errors)[2 * i];
  errors->resize((errors->size() + 1) / 2);
}

void AppendClusters(const std::vector<StatedError>& from, std::int64_t first_cluster,
                    std::vector<StatedError>* into) {
  for (StatedError error : from) {
    error.cluster += first_cluster;
    into->push_back(error);
  }
}

// There is an interval only if the number of trials was fixed beforehand and there are two clusters or more.
SummaryRow MakeRow(const SummaryRow& cell, const std::string& quantity, const ClusteredEstimate& area,
                   bool counts_clusters) {
  SummaryRow row = cell;
  row.quantity = quantity;
  row.kind = SummaryRow::Kind::kArea;
  row.value = area.value;
  row.standard_error = area.standard_error;
  const bool has_interval = area.num_clusters > 1 && cell.interval_kind == IntervalKind::kExact;
  row.interval = has_interval ? area.interval : Interval{kNaN, kNaN};
  row.n = std::isnan(area.value) ? 0 : counts_clusters ? area.num_clusters : area.n;
  return row;
}

void AppendArea(const SummaryRow& cell, const std::string& what, const std::vector<StatedError>& errors,
                bool counts_clusters, std::vector<SummaryRow>* rows) {
  const ClusteredEstimate none{kNaN, kNaN, {kNaN, kNaN}, 0, 0};
  const Sparsification measured = errors.empty() ? Sparsification{none, none} : MeasureSparsification(errors);
  rows->push_back(MakeRow(cell, what + "_ause", measured.ause, counts_clusters));
  rows->push_back(MakeRow(cell, what + "_ause_random", measured.ause_random, counts_clusters));
}

}  // namespace

void ErrorRanking::Add(const TrialRecord& record) {
  if (record.status != MotionStatus::kOk || !IsCounted(record) || !record.density.HasCovariance()) return;
  if (num_seen_++ % stride_ != 0) return;
  AddIfKnown(record.density.rotation_sd_deg, record.rotation_error_deg, cluster_, &rotations_);
  AddIfKnown(record.density.direction_sd_deg, record.direction_error_deg, cluster_, &directions_);
  if (rotations_.size() < kMostErrors) return;
  KeepEverySecond(&rotations_);
  KeepEverySecond(&directions_);
  stride_ *= 2;
}

void ErrorRanking::Merge(const ErrorRanking& other) {
  EndCluster();
  AppendClusters(other.rotations_, cluster_, &rotations_);
  AppendClusters(other.directions_, cluster_, &directions_);
  cluster_ += other.cluster_;
}

void ErrorRanking::AppendRows(const SummaryRow& cell, bool counts_clusters,
                              std::vector<SummaryRow>* rows) const {
  AppendArea(cell, "rotation", rotations_, counts_clusters, rows);
  AppendArea(cell, "direction", directions_, counts_clusters, rows);
}

const std::vector<QuantityHelp>& ErrorRankingQuantities() {
  static const std::vector<QuantityHelp> all = [] {
    const std::string kind = KindName(SummaryRow::Kind::kArea);
    const std::string base = "as energy_score_deg";
    return std::vector<QuantityHelp>{
        {"rotation_ause", kind,
         "area between the sparsification curves by rotation_sd_deg and by rotation error, over the "
         "mean error; 0 best; not of counts",
         base},
        {"rotation_ause_random", kind, "the same for a random order", base},
        {"direction_ause", kind, "rotation_ause for direction errors and direction_sd_deg", base},
        {"direction_ause_random", kind, "the same for a random order", base}};
  }();
  return all;
}

bool IsOfErrorRanking(const std::string& quantity) {
  return std::ranges::count(ErrorRankingQuantities(), quantity, &QuantityHelp::name) > 0;
}

}  // namespace rcme
