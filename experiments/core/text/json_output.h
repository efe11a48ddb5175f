// The JSON documents that the program writes: each is an object whose first key is its format.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "experiments/core/text/write_text.h"

namespace rcme {

// A program that reads these documents should refuse a format that it does not know. The number is increased
// whenever a key is removed or changes its meaning. docs/output_formats.md has the same list.
inline constexpr const char* kAnswerFormat = "rcme answer 1";
inline constexpr const char* kAuditFormat = "rcme audit 1";
inline constexpr const char* kAuditPlanFormat = "rcme audit plan 1";
inline constexpr const char* kBudgetFormat = "rcme budget 1";
inline constexpr const char* kCheckFormat = "rcme check 1";
inline constexpr const char* kPartFormat = "rcme part 2";
inline constexpr const char* kComparisonFormat = "rcme comparison 1";
inline constexpr const char* kConformReportFormat = "rcme conform report 1";
inline constexpr const char* kCrossingsFormat = "rcme crossings 1";
inline constexpr const char* kEstimateFormat = "rcme estimate 2";
inline constexpr const char* kEstimatesFormat = "rcme estimates 1";
inline constexpr const char* kGateFormat = "rcme gate 1";
inline constexpr const char* kIntegrityFormat = "rcme integrity 1";
inline constexpr const char* kFailuresFormat = "rcme failures 1";
inline constexpr const char* kListFormat = "rcme list 1";
inline constexpr const char* kMapFormat = "rcme map 1";
inline constexpr const char* kMarginalsFormat = "rcme marginals 1";
inline constexpr const char* kMatchFormat = "rcme match 1";
inline constexpr const char* kMergeFormat = "rcme merge 1";
inline constexpr const char* kModelChoiceFormat = "rcme model choice 2";
inline constexpr const char* kNoiseCalibrationFormat = "rcme noise calibration 1";
inline constexpr const char* kPairsFormat = "rcme pairs 1";
inline constexpr const char* kPaperTableFormat = "rcme paper table 1";
inline constexpr const char* kRareFormat = "rcme rare 2";
inline constexpr const char* kReliabilityFormat = "rcme reliability 1";
inline constexpr const char* kRepetitionsFormat = "rcme tuning repetitions 1";
inline constexpr const char* kReportFormat = "rcme report 1";
inline constexpr const char* kRunFormat = "rcme run 1";
inline constexpr const char* kStrataFormat = "rcme strata 1";
inline constexpr const char* kSummaryFormat = "rcme summary 1";
inline constexpr const char* kSurfaceFormat = "rcme surface 1";
inline constexpr const char* kSurfaceDataFormat = "rcme surface data 1";
inline constexpr const char* kTransferFormat = "rcme transfer 1";
inline constexpr const char* kTrialFormat = "rcme trial 2";
inline constexpr const char* kTruthCheckFormat = "rcme truth check 1";
inline constexpr const char* kTuningFormat = "rcme tuning 1";
inline constexpr const char* kTwinFormat = "rcme twin 1";
inline constexpr const char* kValidationFormat = "rcme validation 3";
inline constexpr const char* kWorstFormat = "rcme worst 1";  // written by plots/worst_search/report.py

// Returns the text of `object` with `format` as its first key. Bytes that are not UTF-8, for instance in
// names from the input, are replaced.
std::string JsonText(const char* format, const nlohmann::ordered_json& object);
// Writes the same text piece by piece, for an array of millions of rows that should not be in memory as JSON
// at once. `object` has an empty array at `key`; next_rows() returns the next rows of that array, and an
// empty array at the end.
void WriteJson(const char* format, const nlohmann::ordered_json& object, const std::string& key,
               const std::function<nlohmann::ordered_json()>& next_rows, const WriteText& write);

}  // namespace rcme
