// Programs without a Python.
#pragma once

#include <cstdlib>
#include <optional>
#include <string>

namespace rcme {

// While it lives, programs that are run find no Python that starts, as on a machine without one: they draw no
// figures, which would take most of their time. For tests that look at none.
class WithoutPython {
 public:
  WithoutPython() {
    if (const char* home = std::getenv("PYTHONHOME")) before_ = home;
    setenv("PYTHONHOME", "/nowhere", 1);
  }
  ~WithoutPython() {
    if (before_)
      setenv("PYTHONHOME", before_->c_str(), 1);
    else
      unsetenv("PYTHONHOME");
  }
  WithoutPython(const WithoutPython&) = delete;
  WithoutPython& operator=(const WithoutPython&) = delete;

 private:
  std::optional<std::string> before_;
};

}  // namespace rcme
