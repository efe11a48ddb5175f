// Finds temporary files and folders that a killed process left behind. A process holds a lock (flock) on
// each of its own; the system releases it however the process ends. Whoever gets the lock therefore knows
// that nobody uses the file. Its age would not tell.
#pragma once

#include <string>

namespace rcme {

// Locks a file or folder that was just made at `path` and is open as `descriptor`. Returns false if another
// process took it for abandoned in the meantime; then it must be made again. On a file system without locks
// it stays unlocked, and nobody removes it.
bool LockOwn(const std::string& path, int descriptor);

// Calls `remove` with `path` if it is an abandoned file or folder: one of this user that no process has
// locked. The lock is held during the call. Everything else stays, symbolic links too.
void RemoveIfAbandoned(const std::string& path, void (*remove)(const std::string& path));

}  // namespace rcme
