#include "experiments/commands/process_option.h"

#include <string>

#include "experiments/core/text/message.h"
#include "experiments/study/command_permission.h"

namespace rcme {

void AddProcessOption(CLI::App* command, bool* is_allowed) {
  command->add_flag("--allow-process", *is_allowed,
                    "run the commands of `process` estimators in files, after printing them; "
                    "without it such a file is refused (docs/threat_model.md)");
}

void AllowAndSay(std::vector<EstimatorSpec>* estimators) {
  for (const std::string& sentence : AllowCommands(estimators)) PrintMessage("{}\n", sentence);
}

}  // namespace rcme
