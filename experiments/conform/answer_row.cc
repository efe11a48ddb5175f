#include "experiments/conform/answer_row.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <span>

#include "stats/random.h"

namespace rcme {

void AnswerRows::SetShares() {
  std::map<std::int64_t, double> sizes;
  for (const AskedProblem& problem : problems) sizes[problem.group] += 1.0;
  for (AnswerRow& row : rows) row.share = 1.0 / sizes.at(row.group);
}

AnswerRows AnswerRows::Part(const std::function<bool(std::int64_t group)>& is_wanted) const {
  AnswerRows part;
  std::ranges::copy_if(rows, std::back_inserter(part.rows), is_wanted, &AnswerRow::group);
  std::ranges::copy_if(problems, std::back_inserter(part.problems), is_wanted, &AskedProblem::group);
  return part;
}

std::int64_t AnswerRows::CountGroups() const {
  std::set<std::int64_t> groups;
  for (const AskedProblem& problem : problems) groups.insert(problem.group);
  return std::ssize(groups);
}

std::int64_t AnswerRows::CountRefusals() const {
  return std::ranges::count(problems, true, &AskedProblem::is_refused);
}

bool AnswerRows::HasSharedGroups() const { return CountGroups() < std::ssize(problems); }

std::map<std::int64_t, size_t> ShuffleGroups(const AnswerRows& answers) {
  std::set<std::int64_t> names;
  for (const AskedProblem& problem : answers.problems) names.insert(problem.group);
  std::vector<std::int64_t> order(names.begin(), names.end());
  RandomStream rng({.seed = 1, .condition = 0, .trial = 0, .purpose = 1});
  rng.Shuffle(std::span(order));
  std::map<std::int64_t, size_t> places;
  for (size_t i = 0; i < order.size(); ++i) places[order[i]] = i;
  return places;
}

}  // namespace rcme
