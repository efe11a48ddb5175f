#include "experiments/commands/time_limit.h"

#include <fmt/format.h>

#include <chrono>

#include "experiments/core/text/duration.h"
#include "experiments/core/work/stop_request.h"
#include "parameters/plain_text.h"

namespace rcme {

CLI::Option* AddTimeLimit(CLI::App* command, const std::string& pieces, std::string* max_time) {
  return command
      ->add_option(
          "--max-time", *max_time,
          fmt::format(
              "stop after this time (55m, 1h30m, 90s), between two {}; exit code 75 if some are left: "
              "the same command resumes",
              pieces))
      ->check([](const std::string& text) {
        return ParseDuration(text) ? std::string()
                                   : Quoted(text) + " is not allowed; give a time as 55m, 1h30m or 90s";
      });
}

void StartTimeLimit(const std::string& max_time) {
  if (max_time.empty()) return;
  StopAfter(std::chrono::duration<double>(ParseDuration(max_time).value()));
}

}  // namespace rcme
