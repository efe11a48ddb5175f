#include "experiments/core/work/kept_steps.h"

#include "experiments/core/text/message.h"
#include "experiments/core/work/stop_request.h"

namespace rcme {

KeptSteps::KeptSteps(Runner* runner) : runner_(runner) {
  const WorkResults& kept = runner->results();
  if (!kept.results.empty())
    PrintMessage("{} {}s are there already\n", kept.results.size(), runner->plan().item_name);
}

void StopBeforeStep() {
  if (IsStopRequested()) throw Stopped("stopped; nothing was kept");
}

}  // namespace rcme
