// The HDF5 files of posebench as they are stored, read with libhdf5. The library is not made for files that
// were damaged on purpose: posebench.cc calls this in a process of its own.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace rcme {

struct StoredCamera {
  std::string model;  // as COLMAP calls it
  double width = 0.0, height = 0.0;
  std::vector<double> params;
};

struct StoredPair {
  std::vector<double> x1, x2;  // N x 2, row by row, px
  std::vector<double> R, t;    // 9, row by row, and 3
  StoredCamera camera1, camera2;
};

// A file opened for reading. Reads no other file: links, external storage and virtual datasets are refused,
// and filters other than gzip, shuffle and fletcher32 (plugins are not loaded). What a dataset unpacks to is
// bounded before it is unpacked, by kMaxMatchesPerFile and by what it takes in the file.
class PosebenchFile {
 public:
  // Throws InputError that names the path, as all below: it is no HDF5 file, or the program was built without
  // the library.
  explicit PosebenchFile(const std::string& path);
  ~PosebenchFile();
  PosebenchFile(const PosebenchFile&) = delete;
  PosebenchFile& operator=(const PosebenchFile&) = delete;

  std::vector<std::string> ListGroups() const;  // in the order of names
  // Numbers as they are stored, finite or not; `name` is one of ListGroups.
  StoredPair ReadGroup(const std::string& name) const;

 private:
  struct Handle;
  std::string path_;
  std::unique_ptr<Handle> file_;
};

}  // namespace rcme
