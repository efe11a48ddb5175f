#include "experiments/commands/failure_bounds_option.h"

#include <fmt/format.h>

#include <algorithm>

#include "parameters/input_error.h"
#include "parameters/parameter.h"
#include "parameters/plain_text.h"

namespace rcme {

FailureBounds ParseFailureBounds(const std::string& text) {
  const size_t comma = std::min(text.find(','), text.size());
  FailureBounds bounds;
  const auto is_angle = [](const std::string& part, double* angle) {
    return ParseReal(part, angle) && *angle > 0.0 && *angle <= 180.0;
  };
  if (comma < text.size() && is_angle(text.substr(0, comma), &bounds.max_rotation_error_deg) &&
      is_angle(text.substr(comma + 1), &bounds.max_direction_error_deg))
    return bounds;
  throw InputError(fmt::format(
      "--bounds: {} is not allowed; give R,D: a rotation and a direction in deg, above 0 and up to 180",
      Quoted(text)));
}

}  // namespace rcme
