#pragma once

#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "experiments/core/files/pending_file.h"

namespace rcme {

// Writes a text file whole or not at all: to a temporary neighbour first (pending_file.h), then renamed over
// `path`. It is on the disk when this returns. A device or pipe is written directly; a result store is never
// replaced: it may hold hours of work. Throws InputError that names the path and the reason.
void WriteFileWhole(const std::string& path, const std::string& text);

// A file that is written piece by piece, whole or not at all: it takes its place at Finish, and without that
// call nothing is left of it. Standard output where `path` is empty. Errors are those of WriteFileWhole.
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
  std::optional<PendingFile> pending_;  // nothing: written in place
  std::FILE* file_ = nullptr;
};

// Before long work whose result goes to this file: throws as WriteFileWhole would, changes nothing.
void CheckCanBeWritten(const std::string& path);

// Throws InputError if the file to be written is one of those that are read.
void CheckIsNoInput(const std::string& path, const std::vector<std::string>& inputs);

// WriteFileWhole, or to standard output where `path` is empty.
void PrintOrWrite(const std::string& path, const std::string& text);

// Makes a folder for results, with its parents, before the work whose results go there. Throws InputError
// that names the path and the reason if that fails or the folder cannot be written to.
void MakeResultFolder(const std::string& path);

}  // namespace rcme
