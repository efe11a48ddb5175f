// The keys of a study file: what the reader accepts, and what `rcme list keys` and the reference say of each.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace rcme {

// Limits that the readers share with what is said of the keys.
inline constexpr size_t kMaxEstimators = 100;  // of a study
inline constexpr double kLeastBudgetMs = 1e-6, kMostBudgetMs = 1e9;

// A key of one block of the file. The blocks: "study" (the top), "ademp", "estimators" (what an
// entry of the list may be beside an estimator), "estimator" (such an entry, or an estimator file),
// "failure", "hypothesis" (an entry of the list), "conditions", "population" (a file of one), "tune". The
// keys of `data` and `factors` are those of the data (DescribeSettings), those of an estimator's `options`
// are its parameters.
struct StudyKey {
  std::string block, name;
  std::string value;  // the default; empty: none
  std::string allowed, doc;
};

// All of them, block by block.
std::vector<StudyKey> StudyKeys();

// The names of a block's keys.
std::set<std::string> ListStudyKeys(const std::string& block);

}  // namespace rcme
