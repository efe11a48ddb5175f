#include "experiments/study.h"

namespace rcme {

std::vector<Parameter> Parameters(FailureBounds& bounds) {
  return {Parameter::Real("max_rotation_error_deg", &bounds.max_rotation_error_deg, {0.0, 180.0}, "deg",
                          "a motion with a greater rotation error has failed"),
          Parameter::Real("max_direction_error_deg", &bounds.max_direction_error_deg, {0.0, 180.0}, "deg",
                          "a motion with a greater error of the translation direction has failed")};
}

}  // namespace rcme
