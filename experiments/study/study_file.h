// Studies as YAML files:
//
//   name: failure_vs_outliers
//   description: one sentence or more
//   ademp: {aims: ..., data: ..., estimands: ..., methods: ..., performance: ...}
//   seed: 1
//   trials: 400                       # per condition
//   repeats_per_scene: 10             # 1 by default; see study.h
//   data: {scene: uniform_volume, num_matches: 500, sigma_px: 0.5}
//   design: full_factorial            # or one_at_a_time; see study.h
//   factors:
//     outlier_ratio: [0.0, 0.2, 0.4]  # any data key, also cameras, motion, noise, outliers, scene
//     rcme_rank_aware.mu: [3, 6]      # or an option of an estimator, by its label
//   conditions: {design: sobol, number: 256, ranges: {sigma_px: {log: [0.1, 3]}}}   # see population_file.h
//   estimators:
//     - {name: standard}
//     - {name: rcme, label: rcme_rank_aware, options: {reading: rank_aware}}
//     - {file: tuned.yaml, label: other}  # of estimator_file.h, beside the study; the label is optional
//   failure: {max_rotation_error_deg: 3, max_direction_error_deg: 15}
//   hypotheses:                       # see stated_hypothesis.h
//     - {quantity: failure, estimator: other, against: standard, direction: lower}
//   tune: {estimator: rcme_rank_aware, options: {mu: [3, 6, 9]}}    # see tuning/tuning_file.h
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "experiments/study/study.h"

namespace rcme {

// Reads and validates a study, a path or the name of one that comes with the program
// (core/files/shared_files.h). Every path in it, of estimator files, answers, a folder of pairs or a
// calibration, is seen from its own folder; an estimator file may also be one that comes with the program, by
// its name. Throws InputError with file, line, key and what is allowed for anything that is not: unknown or
// repeated keys, wrong types, values out of range, empty factors, unknown scenes and estimators.
Study LoadStudy(const std::string& name);

// The same from text; `path` is what the messages call it. The paths of its data are seen from the working
// directory, as those of a result file are.
Study ParseStudy(const std::string& yaml, const std::string& path);

// One `--set key=value`: a data key; a failure bound, of the study and of all estimators that have it; or an
// option, of all estimators that have it (`mu`), or of the one with a label (`rcme.mu`), which may be named
// like a data key; or `conditions.number`, `conditions.design` of a population. A factor that is set, or a
// key that is drawn, becomes that one level. Throws InputError that lists what there is, also where the
// options of an estimator then contradict each other.
void Override(Study* study, const std::string& key, const std::string& value);

// The study with every parameter written out, defaults and the estimators of files included: ParseStudy gives
// the same study back but for its tuning, on which no run depends. Two runs may share a result file if this
// text, its trials and words aside, is the same.
std::string ToYaml(const Study& study);

}  // namespace rcme
