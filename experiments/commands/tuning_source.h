// The study of `rcme tune` and `rcme transfer`.
#pragma once

#include <CLI/CLI.hpp>

#include "experiments/commands/study_source.h"

namespace rcme {

struct TuningArguments {
  std::string study;
  StudyChanges changes;
  std::vector<std::string> overrides;  // of the tune block; key=value each
  int threads = 0;
};

void AddTuningOptions(CLI::App* command, TuningArguments* arguments);

// The plan of the study with the changes to its tune block. The severity of the problems is not measured.
// Throws InputError, also if the study has no tune block.
StudyPlan MakeTuningPlan(const TuningArguments& arguments);

}  // namespace rcme
