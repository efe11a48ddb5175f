#pragma once

#include <fmt/format.h>

#include <string>
#include <type_traits>

#include "experiments/study/study_file.h"
#include "experiments/study/study_plan.h"
#include "experiments/trial/trial_columns.h"
#include "parameters/settings.h"

namespace rcme {

// Two conditions, two estimators, quick to run.
inline std::string SmallStudyYaml() {
  return "name: small\n"
         "seed: 3\n"
         "trials: 6\n"
         "data: {scene: uniform_volume, num_matches: 60, sigma_px: 0.5}\n"
         "factors:\n"
         "  outlier_ratio: [0.0, 0.3]\n"
         "estimators:\n"
         "  - {name: standard, options: {num_iterations: 20}}\n"
         "  - {name: rcme, label: ours, options: {num_iterations: 20, reading: rank_aware}}\n";
}

// The value of an option, which is there.
inline std::string ReadOption(const EstimatorSpec& spec, const std::string& option) {
  return FindSetting(spec.options, option).value();
}

inline Study SmallStudy() { return ParseStudy(SmallStudyYaml(), "small.yaml"); }

// Every field of a record but the time, as text with all bits.
inline std::string RecordText(const TrialRecord& record) {
  std::string text;
  VisitColumns(record, [&](const StoredColumn& column, const auto& field) {
    if (column.role != StoredColumn::Role::kTime)
      text += fmt::format("{}={} ", column.name, FormatField(field));
  });
  return text;
}

}  // namespace rcme
