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
      {"study", "name", "the file's name", "letters, digits, _, - and .", "what results call the study"},
      {"study", "description", "", "text", "what it asks, in a sentence"},
      {"study", "ademp", "", "the keys of ademp, all of them",
       "aims, data, estimands, methods and performance, for readers (Morris, White & Crowther 2019)"},
      {"study", "seed", "1", "a whole number >= 0", "of all random streams"},
      {"study", "trials", "100", "a whole number >= 1",
       "per condition; of a folder of pairs, passes over each pair"},
      {"study", "repeats_per_scene", "1", fmt::format("a whole number in [1, {}]", kMaxRepeatsPerScene),
       "consecutive trials that meet one scene and differ in the samples of the estimators"},
      {"study", "common_scenes", "false", "one of: true, false",
       "the same scenes in all conditions whose scene is shaped alike, so that their differences are paired"},
      {"study", "data", "", "a map; `scene` must be there, all else has a default (`rcme list settings`)",
       "what is simulated, or which folder of match files is read"},
      {"study", "design", "full_factorial", "one of: full_factorial, one_at_a_time",
       "all combinations of the factors' levels, or each factor alone, the others as in data"},
      {"study", "factors", "none",
       "a map: a key of the data, or LABEL.OPTION of an estimator -> a list of levels",
       "what is varied; a condition is a combination of levels"},
      {"study", "conditions", "none", "the keys of conditions",
       "a population that the conditions are drawn from"},
      {"conditions", "population", "none", "a population file, or a name of `rcme list populations`",
       "ranges and restrictions to begin with"},
      {"conditions", "draws", "0 to number - 1",
       fmt::format("a list of whole numbers in [0, {}]; of latin_hypercube below number", kMaxDraws - 1),
       "the numbers of the draws, where they are chosen: they are no sample of the population"},
      {"conditions", "ranges", "those of population",
       "a map: a key of the data -> [from, to], {log: [from, to]}, "
       "{any: [...]}, any, or names with what is drawn with each",
       "what each key may be; takes the place of the population's"},
      {"conditions", "given", "none", "KEY < NUMBER or KEY < KEY, also with <=, >, >=, or a list of such",
       "what a draw has to meet to be a condition; one without the key is not restricted"},
      {"population", "description", "", "text", "what it stands for"},
      {"population", "source", "", "text", "where its ranges are from"},
      {"population", "reasons", "none", "a map of texts", "why each range is as it is"},
      {"population", "left_out", "none", "a map of texts", "keys of the data that are not drawn, and why"},
      {"population", "ranges", "", "as in conditions", "what each key may be"},
      {"population", "given", "none", "as in conditions", "what a draw has to meet to be a condition"},
      {"study", "estimators", "",
       fmt::format("a list of 1 to {} entries, each with the keys of estimator, or file", kMaxEstimators),
       "what is compared, on the same matches"},
      {"study", "failure", "", "the keys of failure", "when a motion counts as failed"},
      {"study", "hypotheses", "none",
       fmt::format("a list of 1 to {} entries, each with the keys of hypothesis", kMaxHypotheses),
       "what the run is expected to show, decided by intervals that hold together (`rcme lock`)"},
      {"hypothesis", "quantity", "", fmt::format("one of: {}", fmt::join(StatableQuantities(), ", ")),
       "a rate or score of the summary"},
      {"hypothesis", "estimator", "", "a label of the study", "whose"},
      {"hypothesis", "at_least", "none", "a number in [0, 1]", "the value is not below it"},
      {"hypothesis", "at_most", "none", "a number in [0, 1]", "the value is not above it"},
      {"hypothesis", "against", "none", "another label of the study",
       "the estimator it is compared with, on the same trials; needs direction"},
      {"hypothesis", "direction", "none", "one of: lower, higher, not_lower, not_higher",
       "how the value compares with that of against"},
      {"hypothesis", "margin", "0", "a number in [0, 1]; greater than 0 for not_lower and not_higher",
       "lower and higher: by more than this; not_lower and not_higher: by less than this"},
      {"hypothesis", "where", "all conditions", "a map: a factor -> one of its levels",
       "the conditions that the hypothesis is of"},
      {"study", "tune", "none", "the keys of tune", "what `rcme tune` and `rcme transfer` do with the study"},
      {"estimator", "name", "", "a name of `rcme list estimators`",
       "the estimator; or process, or answers, or conform, or file (in a study)"},
      {"estimator", "process", "", "a command for sh", "an estimator in any language, by lines of JSON"},
      {"estimator", "answers", "", "a path, seen from the file that names it",
       "answers that were made elsewhere (`rcme export`)"},
      {"estimator", "conform", "", "a path, seen from the file that names it",
       "an estimator that is made to keep its word (`rcme conform`)"},
      {"estimator", "label", "the name",
       "one line of at most 200 bytes, without commas; different ones in a study", "what results call it"},
      {"estimator", "options", "", "a map of its options (`rcme list options`)",
       "those that are not at their defaults"},
      {"estimator", "budget_ms", "none",
       fmt::format("a number in [{}, {:.0f}]", kLeastBudgetMs, kMostBudgetMs),
       "time of a call that its effort was chosen for (`rcme budget`); kept for people"},
      {"estimator", "provenance", "none", "a map of any texts",
       "where its options are from; kept for people"},
      {"estimators", "file", "", "a path, seen from the study's folder",
       "an estimator file with these same keys; a label beside it takes the place of the file's"},
      {"tune", "options", "", "a map: option -> levels, or {from: 0, to: 12, step: 0.5}",
       fmt::format("what is open; at most {} combinations", kMaxTunedSettings)}};
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
