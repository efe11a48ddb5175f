// The block `conditions` of a study, and populations as files of their own (populations/NAME.yaml):
//
//   conditions:
//     population: hand_held_indoor     # optional: a file, or the name of one that comes with the program
//     design: sobol                    # or latin_hypercube, random (stats/point_set.h)
//     number: 256                      # of draws
//     draws: [3, 300]                  # optional: these alone; of sobol and random also beyond `number`
//     ranges:                          # beside those of the file, or in their place
//       outlier_ratio: [0, 0.8]        # two numbers: uniform from the first to the second
//       sigma_px: {log: [0.1, 3]}      # uniform in its logarithm; outside of braces also: log [0.1, 3]
//       num_matches: {any: [50, 500]}  # one of these, each as likely; one that stands twice, twice as likely
//       noise: any                     # any law there is, with its usual settings
//       motion: [hand_held, orbit]     # one of these; outside of braces also: any of [hand_held, orbit]
//       focal_px: 500                  # always
//       max_rotation_deg: [1, 20]      # drawn where a motion was drawn that has the key
//       scene:                         # one of these ...
//         room: {num_boxes: [0, 10], cameras: [office, euroc]}  # ... with what is drawn in it alone
//         plane: {}
//     given: [parallax_deg > 0.3]      # a draw that does not meet it keeps its number, but is no condition
//
// A population's file has `description`, `source`, `reasons` (a map of texts), `left_out` (keys of the data
// that are not drawn, with the reason), `ranges` and `given`.
#pragma once

#include <string>

#include "experiments/core/files/yaml_input.h"
#include "experiments/study/study.h"

namespace rcme {

// What comes with a population, for people.
struct PopulationText {
  std::string description, source;
  Settings reasons, left_out;
};
// Reads a population's file, or the one of that name that comes with the program. Throws InputError as
// LoadStudy does.
Population LoadPopulation(const std::string& name, PopulationText* text = nullptr);

// The block of a study, whose place is `place`.
Population ReadPopulation(const Place& place, const YAML::Node& node);

// The block with everything written out: ReadPopulation gives the same population back.
void WritePopulation(const Population& population, YAML::Emitter* out);

// The design's name, for `--set conditions.design=random` and the list of keys.
Parameter PopulationDesignParameter(PointSet* design);
Parameter PopulationNumberParameter(int* number);

}  // namespace rcme
