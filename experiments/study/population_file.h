// The block `conditions` of a study, and population files (populations/NAME.yaml):
//
//   conditions:
//     population: hand_held_indoor     # optional: a file, or the name of an installed one
//     design: sobol                    # or latin_hypercube, random (stats/point_set.h)
//     number: 256                      # number of draws
//     draws: [3, 300]                  # optional: only these draws; sobol, random: also beyond `number`
//     ranges:                          # added to the ranges of the population, or replacing them
//       outlier_ratio: [0, 0.8]        # two numbers: uniform between them
//       sigma_px: {log: [0.1, 3]}      # log-uniform; outside of braces also: log [0.1, 3]
//       num_matches: {any: [50, 500]}  # equally likely values; a repeated one is twice as likely
//       noise: any                     # any noise law, with its usual settings
//       motion: [hand_held, orbit]     # equally likely words; outside of braces also: any of [...]
//       focal_px: 500                  # fixed
//       max_rotation_deg: [1, 20]      # drawn if the drawn motion has this key
//       scene:                         # equally likely words, ...
//         room: {num_boxes: [0, 10], cameras: [office, euroc]}  # ... with ranges of their own
//         plane: {}
//     given: [parallax_deg > 0.3]      # a draw that violates it keeps its number but is no condition
//
// A population file has `description`, `source`, `reasons` (a map of texts), `left_out` (data keys that are
// not drawn, with the reason), `ranges` and `given`.
#pragma once

#include <string>

#include "experiments/core/files/yaml_input.h"
#include "experiments/study/study.h"

namespace rcme {

// The texts of a population file.
struct PopulationText {
  std::string description, source;
  Settings reasons, left_out;
};
// Reads a population file, given by its path or by the name of one that is installed with the program.
// Throws InputError as LoadStudy does.
Population LoadPopulation(const std::string& name, PopulationText* text = nullptr);

// Reads the block of a study, located at `place`.
Population ReadPopulation(const Place& place, const YAML::Node& node);

// Writes the block with every value. ReadPopulation returns the same population.
void WritePopulation(const Population& population, YAML::Emitter* out);

// Parameters for `--set conditions.design=random`, `--set conditions.number=512` and the list of keys.
Parameter PopulationDesignParameter(PointSet* design);
Parameter PopulationNumberParameter(int* number);

}  // namespace rcme
