// Reads the HDF5 files of posebench with libhdf5. The library is not safe for maliciously damaged files, so
// posebench.cc calls this in a separate process.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace rcme {

struct StoredCamera {
  std::string model;  // COLMAP's name
  double width = 0.0, height = 0.0;
  std::vector<double> params;
};

struct StoredPair {
  std::vector<double> x1, x2;  // N x 2, row by row, px
  std::vector<double> R, t;    // 9, row by row, and 3
  StoredCamera camera1, camera2;
};

// A file opened for reading. It reads no other file: links, external storage and virtual datasets are
// refused, and so are filters other than gzip, shuffle and fletcher32 (plugins are not loaded). The
// decompressed size of a dataset is bounded in advance, by kMaxMatchesPerFile and by its size in the file.
class PosebenchFile {
 public:
  // Throws InputError that names the path, like all functions below, if it is no HDF5 file or the program
  // was built without the library.
  explicit PosebenchFile(const std::string& path);
  ~PosebenchFile();
  PosebenchFile(const PosebenchFile&) = delete;
  PosebenchFile& operator=(const PosebenchFile&) = delete;

  std::vector<std::string> ListGroups() const;  // ordered by name
  // Returns the stored numbers, finite or not; `name` is one of ListGroups.
  StoredPair ReadGroup(const std::string& name) const;

 private:
  struct Handle;
  std::string path_;
  std::unique_ptr<Handle> file_;
};

}  // namespace rcme
