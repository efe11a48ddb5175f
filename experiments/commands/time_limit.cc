#include "experiments/commands/time_limit.h"

#include <fmt/format.h>

#include <chrono>

#include "experiments/core/text/duration.h"
#include "experiments/core/work/stop_request.h"

namespace rcme {

CLI::Option* AddTimeLimit(CLI::App* command, const std::string& pieces, std::string* max_time) {
  return command
      ->add_option(
          "--max-time", *max_time,
          fmt::format(
              "stop after this time (55m, 1h30m, 90s), between two {}; exit code 75 if some are left: "
              "the same command resumes",
              pieces))
      ->check(ExplainDuration);
}

void StartTimeLimit(const std::string& max_time) {
  if (max_time.empty()) return;
  StopAfter(std::chrono::duration<double>(ParseDuration(max_time).value()));
}

}  // namespace rcme
