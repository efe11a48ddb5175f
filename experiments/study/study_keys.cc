#include "experiments/study/study_keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/study/population_file.h"
#include "experiments/study/stated_hypothesis.h"
#include "experiments/study/study.h"

namespace rcme {
namespace {

const std::vector<StudyKey>& FixedKeys() {
  static const std::vector<StudyKey> keys = {
      {"study", "name", "the file's name", "letters, digits, _, - and .", "name in results"},
      {"study", "description", "", "text", "what it asks, in a sentence"},
      {"study", "ademp", "", "the keys of ademp, all of them",
       "plan of the study in words (Morris, White & Crowther 2019)"},
      {"study", "seed", "1", "a whole number >= 0", "of all random streams"},
      {"study", "trials", "100", "a whole number >= 1",
       "per condition; with match files, passes over each pair"},
      {"study", "repeats_per_scene", "1", fmt::format("a whole number in [1, {}]", kMaxRepeatsPerScene),
       "consecutive trials of one scene, with other samples of the estimators"},
      {"study", "common_scenes", "false", "one of: true, false",
       "the same scenes in all conditions with the same scene settings, for paired differences"},
      {"study", "data", "", "a map; `scene` must be there, all else has a default (`rcme list settings`)",
       "what is simulated, or which match files are read"},
      {"study", "design", "full_factorial", "one of: full_factorial, one_at_a_time",
       "all combinations of levels, or one factor at a time, the others as in data"},
      {"study", "factors", "none",
       "a map: a key of the data, or LABEL.OPTION of an estimator -> a list of levels",
       "what is varied; a condition combines one level of each"},
      {"study", "conditions", "none", "the keys of conditions", "population of which conditions are drawn"},
      {"conditions", "population", "none", "a population file, or a name of `rcme list populations`",
       "initial ranges and restrictions"},
      {"conditions", "draws", "0 to number - 1",
       fmt::format("a list of whole numbers in [0, {}]; of latin_hypercube below number", kMaxDraws - 1),
       "numbers of chosen draws, which are no sample of the population"},
      {"conditions", "ranges", "those of population",
       "a map: a key of the data -> [from, to], {log: [from, to]}, "
       "{any: [...]}, any, or names with what is drawn with each",
       "values of each key, in place of the population's"},
      {"conditions", "given", "none", "KEY < NUMBER or KEY < KEY, also with <=, >, >=, or a list of such",
       "restriction of the draws; a draw without the key meets it"},
      {"population", "description", "", "text", "what it stands for"},
      {"population", "source", "", "text", "where its ranges are from"},
      {"population", "reasons", "none", "a map of texts", "why each range is as it is"},
      {"population", "left_out", "none", "a map of texts", "keys that are not drawn, and why"},
      {"population", "ranges", "", "as in conditions", "values of each key"},
      {"population", "given", "none", "as in conditions", "restriction of the draws"},
      {"study", "estimators", "",
       fmt::format("a list of 1 to {} entries, each with the keys of estimator, or file", kMaxEstimators),
       "what is compared, on the same matches"},
      {"study", "failure", "", "the keys of failure", "failure bounds"},
      {"study", "hypotheses", "none",
       fmt::format("a list of 1 to {} entries, each with the keys of hypothesis", kMaxHypotheses),
       "expected results, decided by simultaneous intervals (`rcme lock`)"},
      {"hypothesis", "quantity", "", fmt::format("one of: {}", fmt::join(StatableQuantities(), ", ")),
       "rate or score of the summary"},
      {"hypothesis", "estimator", "", "a label of the study", "whose"},
      {"hypothesis", "at_least", "none", "a number in [0, 1]", "least value"},
      {"hypothesis", "at_most", "none", "a number in [0, 1]", "greatest value"},
      {"hypothesis", "against", "none", "another label of the study",
       "estimator to compare with, on the same trials; needs direction"},
      {"hypothesis", "direction", "none", "one of: lower, higher, not_lower, not_higher",
       "the value compared with that of against"},
      {"hypothesis", "margin", "0", "a number in [0, 1]; greater than 0 for not_lower and not_higher",
       "lower, higher: by more than this; not_lower, not_higher: by less"},
      {"hypothesis", "where", "all conditions", "a map: a factor -> one of its levels",
       "conditions of the hypothesis"},
      {"study", "tune", "none", "the keys of tune", "for `rcme tune` and `rcme transfer`"},
      {"estimator", "name", "", "a name of `rcme list estimators`",
       "instead: process, answers, conform or (in a study) file"},
      {"estimator", "process", "", "a command for sh", "an estimator in any language, by lines of JSON"},
      {"estimator", "answers", "", "a path, seen from the file that names it",
       "answers made elsewhere (`rcme export`)"},
      {"estimator", "conform", "", "a path, seen from the file that names it",
       "an estimator calibrated by `rcme conform`"},
      {"estimator", "label", "the name",
       "one line of at most 200 bytes, without commas; different ones in a study", "name in results"},
      {"estimator", "options", "", "a map of its options (`rcme list options`)",
       "those that differ from their defaults"},
      {"estimator", "budget_ms", "none",
       fmt::format("a number in [{}, {:.0f}]", kLeastBudgetMs, kMostBudgetMs),
       "time of a call that its effort was chosen for (`rcme budget`); for information"},
      {"estimator", "provenance", "none", "a map of any texts", "origin of its options; for information"},
      {"estimators", "file", "", "a path, seen from the study's folder",
       "estimator file with these keys; a label beside it replaces the file's"},
      {"tune", "options", "", "a map: option -> levels, or {from: 0, to: 12, step: 0.5}",
       fmt::format("tuned options; at most {} combinations", kMaxTunedSettings)}};
  return keys;
}

void Add(const std::string& block, const std::vector<Parameter>& parameters, std::vector<StudyKey>* keys) {
  for (const Parameter& p : parameters) {
    const std::string value = p.unit().empty() ? p.Value() : p.Value() + " " + p.unit();
    keys->push_back({block, p.name(), value, p.allowed(), p.doc()});
  }
}

}  // namespace

std::vector<StudyKey> StudyKeys() {
  std::vector<StudyKey> keys = FixedKeys();
  Ademp ademp;
  for (const auto& [name, text] : Parts(ademp))
    keys.push_back({"ademp", name, "", "text", "in the study's own words"});
  FailureBounds bounds;
  Add("failure", Parameters(bounds), &keys);
  Population population;
  Add("conditions",
      {PopulationDesignParameter(&population.design), PopulationNumberParameter(&population.number)}, &keys);
  Tuning tuning;
  Add("tune", Parameters(tuning), &keys);
  return keys;
}

std::set<std::string> ListStudyKeys(const std::string& block) {
  std::set<std::string> names;
  for (const StudyKey& key : StudyKeys()) {
    if (key.block == block) names.insert(key.name);
  }
  return names;
}

}  // namespace rcme
