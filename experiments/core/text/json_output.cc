#include "experiments/core/text/json_output.h"

#include <nlohmann/json.hpp>

namespace rcme {

std::string JsonText(const char* format, const nlohmann::ordered_json& object) {
  nlohmann::ordered_json stamped = {{"format", format}};
  stamped.update(object);
  return stamped.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace rcme
