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
//     - {file: tuned.yaml, label: other}  # an estimator file (estimator_file.h); the label is optional
//   failure: {max_rotation_error_deg: 3, max_direction_error_deg: 15}
//   hypotheses:                       # see stated_hypothesis.h
//     - {quantity: failure, estimator: other, against: standard, direction: lower}
//   tune: {estimator: rcme_rank_aware, options: {mu: [3, 6, 9]}}    # see study/tuning_file.h
#pragma once

#include <string>

#include "experiments/study/study.h"

namespace rcme {

// Reads and validates a study, given by its path or by the name of one that is installed with the program
// (core/files/shared_files.h). Paths in it (estimator files, answers, a folder of pairs, a calibration) are
// relative to its own folder. An estimator file may also be given by the name of an installed one. Throws
// InputError with file, line, key and what is allowed for unknown or repeated keys, wrong types, values out
// of range, empty factors, unknown scenes and estimators.
Study LoadStudy(const std::string& name);

// The same from text; messages call it `path`. Paths of its data are relative to the working directory, as
// in a result file.
Study ParseStudy(const std::string& yaml, const std::string& path);

// Applies one `--set key=value`. The key is one of these:
// - a data key;
// - a failure bound, of the study and of all estimators that have it;
// - an option, of all estimators that have it (`mu`), or of the estimator with a label (`rcme.mu`), even if
//   a data key has the same name;
// - `conditions.number` or `conditions.design` of a population.
// A factor or drawn key that is set gets this single level. Throws InputError that lists the possible keys
// or values, or if the options of an estimator contradict each other.
void Override(Study* study, const std::string& key, const std::string& value);

// Formats a study with every parameter, defaults and the estimators of files included. ParseStudy returns
// the same study except for its tuning, on which no run depends. Two runs may share a result file if these
// texts agree, apart from trials and descriptions.
std::string ToYaml(const Study& study);

// The same study with paths of its data that hold in every folder; without it they are relative to the
// working directory.
Study WithAbsolutePaths(Study study);

}  // namespace rcme
