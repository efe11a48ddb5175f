#pragma once

#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "experiments/core/files/pending_file.h"

namespace rcme {

// Writes a text file completely or not at all: first to a temporary file beside it (pending_file.h), which
// is then renamed to `path`. The file is on disk when this returns. Devices and pipes are written directly.
// A result store is never replaced, as it may hold hours of work. Throws InputError that names the path and
// the reason.
void WriteFileWhole(const std::string& path, const std::string& text);

// Writes a file piece by piece, completely or not at all: the file appears at `path` when Finish is called,
// and without that call nothing is left behind. An empty `path` means standard output. Throws the errors of
// WriteFileWhole.
class FileInPieces {
 public:
  explicit FileInPieces(const std::string& path);
  ~FileInPieces();
  FileInPieces(const FileInPieces&) = delete;
  FileInPieces& operator=(const FileInPieces&) = delete;

  void Write(const std::string& text);
  void Finish();

 private:
  const std::string path_;              // as the user gave it
  std::optional<PendingFile> pending_;  // empty: the file is written in place
  std::FILE* file_ = nullptr;
};

// Call this before long work whose result goes to `path`: throws if WriteFileWhole would, and changes
// nothing.
void CheckCanBeWritten(const std::string& path);

// Throws InputError if `path` is one of the input files or folders.
void CheckIsNoInput(const std::string& path, const std::vector<std::string>& inputs);

// Writes `text` by WriteFileWhole, or to standard output if `path` is empty.
void PrintOrWrite(const std::string& path, const std::string& text);

// Makes a folder for results and its parents; call this before the work whose results go there. Throws
// InputError that names the path and the reason if the folder cannot be made or written to.
void MakeResultFolder(const std::string& path);

}  // namespace rcme
