// The peak of this process's resident memory while something runs, from the kernel's own account.
#pragma once

#include <malloc.h>

#include <fstream>
#include <functional>
#include <string>

namespace rcme {

// A line of /proc/self/status, "VmHWM" or "VmRSS", in MB; negative if there is none.
inline double MemoryStatusMb(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (double kb = 0.0; word == key + ":" && status >> kb) return kb / 1024.0;
  }
  return -1.0;
}

// Sets the kernel's peak back to what is resident now.
inline bool ResetPeakMemory() {
  std::ofstream clear("/proc/self/clear_refs");
  clear << 5 << std::flush;
  return clear.good();
}

// False where the kernel does not tell, and in sanitizer builds, which keep freed memory.
inline bool CanMeasurePeakMemory() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return false;
#else
  return ResetPeakMemory() && MemoryStatusMb("VmHWM") > 0.0;
#endif
}

// By how much `action` raises the resident memory at its peak.
inline double PeakMemoryMb(const std::function<void()>& action) {
  malloc_trim(0);  // else the action would first fill what earlier ones have left
  ResetPeakMemory();
  const double before_mb = MemoryStatusMb("VmRSS");
  action();
  return MemoryStatusMb("VmHWM") - before_mb;
}

}  // namespace rcme
