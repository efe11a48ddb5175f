// Temporary files and folders whose process may be killed. The process holds a lock (flock) on them, which the
// system releases however the process ends. So whoever gets the lock knows that nobody else uses them;
// their age says nothing.
#pragma once

#include <string>

namespace rcme {

// Locks what was just made at `path`, of which `descriptor` is open. False: another process took it for
// abandoned in between, so that it has to be made again. On a file system without locks it stays unlocked,
// and nobody removes it.
bool LockOwn(const std::string& path, int descriptor);

// Calls `remove` with the path while it holds the lock of a file or folder that was abandoned: one of this
// user that no process has locked. Anything else is left alone, a symbolic link among it.
void RemoveIfAbandoned(const std::string& path, void (*remove)(const std::string& path));

}  // namespace rcme
