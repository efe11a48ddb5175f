// The keys of a study file: what the reader accepts, and what `rcme list keys` and the reference document.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace rcme {

// Limits used both by readers and in the documentation of keys.
inline constexpr size_t kMaxEstimators = 100;  // of a study
inline constexpr double kLeastBudgetMs = 1e-6, kMostBudgetMs = 1e9;

// A key of one block of the file. The blocks are "study" (the top level), "ademp", "estimators" (keys of a
// list entry that an estimator file does not have), "estimator" (keys of a list entry and of an estimator
// file), "failure", "hypothesis" (an entry of the list), "conditions", "population" (a population file) and
// "tune". The keys of `data` and `factors` are data settings (DescribeSettings); the keys of an estimator's
// `options` are its parameters.
struct StudyKey {
  std::string block, name;
  std::string value;  // the default; empty: none
  std::string allowed, doc;
};

// Returns all keys, block by block.
std::vector<StudyKey> StudyKeys();

// Returns the names of a block's keys.
std::set<std::string> ListStudyKeys(const std::string& block);

}  // namespace rcme
