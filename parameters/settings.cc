#include "parameters/settings.h"

namespace rcme {

std::optional<std::string> FindSetting(const Settings& settings, const std::string& key) {
  std::optional<std::string> last;
  for (const auto& [name, value] : settings) {
    if (name == key) last = value;
  }
  return last;
}

}  // namespace rcme
