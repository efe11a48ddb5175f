#include "experiments/core/text/message.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>

namespace rcme {

void WriteMessage(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
  std::clearerr(stderr);
}

void HoldStandardStreams() {
  int file = -1;
  do {
    file = open("/dev/null", O_RDONLY);
  } while (file >= 0 && file <= STDERR_FILENO);
  if (file >= 0) close(file);
}

}  // namespace rcme
