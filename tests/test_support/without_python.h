// Programs without a Python.
#pragma once

#include <cstdlib>

namespace rcme {

// While it lives, programs that are run find no Python that starts, as on a machine without one: they draw no
// figures, which would take most of their time. For tests that look at none.
struct WithoutPython {
  WithoutPython() { setenv("PYTHONHOME", "/nowhere", 1); }
  ~WithoutPython() { unsetenv("PYTHONHOME"); }
  WithoutPython(const WithoutPython&) = delete;
  WithoutPython& operator=(const WithoutPython&) = delete;
};

}  // namespace rcme
