// HDF5 files as posebench keeps pairs, written with the same library.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "experiments/real/sequences/listed_pairs.h"
#include "stats/random.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/paths.h"
#include "tests/test_support/temp_folder.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

constexpr int kMatches = 40;

void PutNumbers(hid_t group, const char* name, const std::vector<hsize_t>& shape,
                const std::vector<double>& values, hid_t stored_as = H5T_IEEE_F64LE) {
  const hid_t space = H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
  const hid_t data = H5Dcreate2(group, name, stored_as, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Dclose(data);
  H5Sclose(space);
}

// As h5py writes an array of one text.
void PutText(hid_t group, const char* name, const std::string& text, bool is_variable) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, is_variable ? H5T_VARIABLE : text.size());
  const hsize_t one = 1;
  const hid_t space = H5Screate_simple(1, &one, nullptr);
  const hid_t data = H5Dcreate2(group, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  const char* pointer = text.c_str();
  H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT,
           is_variable ? static_cast<const void*>(&pointer) : static_cast<const void*>(text.c_str()));
  H5Dclose(data);
  H5Sclose(space);
  H5Tclose(type);
}

// Two pairs of a simulated scene; the first as PINHOLE with numbers of 64 bits, the second as SIMPLE_RADIAL
// without distortion with numbers of 32 bits. COLMAP's pixels are half a pixel further.
class Posebench : public testing::Test {
 protected:
  Posebench() {
    const hid_t file = H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    for (const bool is_second : {false, true}) {
      const char* name = is_second ? "b-pair_2.jpg" : "a";
      const hid_t pair = H5Gcreate2(file, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
      WritePair(pair, is_second);
      H5Gclose(pair);
    }
    H5Fclose(file);
  }

  void WritePair(hid_t pair, bool is_second) const {
    const hid_t number = is_second ? H5T_IEEE_F32LE : H5T_IEEE_F64LE;
    std::vector<double> x1, x2, R, t;
    for (const Correspondence& match : observed_.matches) {
      x1.insert(x1.end(), {match.x1_px.x() + 0.5, match.x1_px.y() + 0.5});
      x2.insert(x2.end(), {match.x2_px.x() + 0.5, match.x2_px.y() + 0.5});
    }
    PutNumbers(pair, "x1", {x1.size() / 2, 2}, x1, number);
    PutNumbers(pair, "x2", {x2.size() / 2, 2}, x2, number);
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) R.push_back(scene_.cam2_from_cam1_true.R(row, column));
      t.push_back(4.0 * scene_.cam2_from_cam1_true.t[row]);
    }
    PutNumbers(pair, "R", {3, 3}, R, number);
    PutNumbers(pair, "t", is_second ? std::vector<hsize_t>{3, 1} : std::vector<hsize_t>{3}, t, number);
    for (const auto& [name, camera] :
         {std::pair{"camera1", scene_.camera1}, std::pair{"camera2", scene_.camera2}}) {
      const hid_t group = H5Gcreate2(pair, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
      PutText(group, "model", is_second ? "SIMPLE_RADIAL" : "PINHOLE", !is_second);
      PutNumbers(group, "width", {1}, {1.0 * camera.width}, H5T_STD_I64LE);
      PutNumbers(group, "height", {1}, {1.0 * camera.height}, H5T_STD_I64LE);
      const double cx = camera.cx + 0.5, cy = camera.cy + 0.5;
      const std::vector<double> params = is_second ? std::vector<double>{camera.fx, cx, cy, 0.0}
                                                   : std::vector<double>{camera.fx, camera.fy, cx, cy};
      PutNumbers(group, "params", {4}, params);
      H5Gclose(group);
    }
  }

  static void ReadAll(const std::string& path) {
    DatasetOptions options;
    options.folder = path;
    const auto pairs = OpenPosebench(options);
    for (size_t i = 0; i < pairs->size(); ++i) pairs->Read(i);
  }
  // What is said of a copy that is changed.
  testing::AssertionResult Refuses(const std::function<void(hid_t file)>& change,
                                   const std::vector<std::string>& fragments) const {
    const std::string copy = folder_.Path("changed.h5");
    std::filesystem::copy_file(path_, copy, std::filesystem::copy_options::overwrite_existing);
    const hid_t file = H5Fopen(copy.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    change(file);
    H5Fclose(file);
    return ThrowsInputError([&] { ReadAll(copy); }, fragments);
  }

  const Scene scene_ = TwoCameraScene(kMatches, 0);
  const Observation observed_ = ObserveTwoCameraScene(scene_, 0.5, 0.1, 0);
  TempFolder folder_;
  const std::string path_ = folder_.Path("scannet_sift.h5");
};

TEST_F(Posebench, PairsAreReadOneAtATime) {
  DatasetOptions options;
  options.folder = path_;
  const auto pairs = OpenPosebench(options);
  ASSERT_EQ(pairs->size(), 2u);
  EXPECT_EQ(pairs->PairId(1), "scannet_sift_000001");
  for (size_t i = 0; i < 2; ++i) {
    const ListedPair listed = pairs->Read(i);
    const double within = i == 0 ? 1e-9 : 1e-3;  // of numbers of 32 bits
    EXPECT_EQ(listed.file.scene, "scannet_sift");
    EXPECT_NEAR(listed.file.camera1.fx, scene_.camera1.fx, 1e-9);
    EXPECT_NEAR(listed.file.camera2.cy, scene_.camera2.cy, 1e-9);
    EXPECT_EQ(listed.file.camera2.width, scene_.camera2.width);
    ASSERT_EQ(listed.file.matches.size(), observed_.matches.size());
    EXPECT_LT((listed.file.matches[7].x1_px - observed_.matches[7].x1_px).norm(), within);
    EXPECT_LT((listed.file.matches[7].x2_px - observed_.matches[7].x2_px).norm(), within);
    ASSERT_TRUE(listed.file.cam2_from_cam1_true.has_value());
    EXPECT_LT((listed.file.cam2_from_cam1_true->R - scene_.cam2_from_cam1_true.R).norm(), 1e-6);
    EXPECT_LT((listed.file.cam2_from_cam1_true->t - scene_.cam2_from_cam1_true.t).norm(), 1e-6);
    EXPECT_TRUE(std::isnan(listed.baseline));
    EXPECT_FALSE(listed.is_direction_weak);
  }
  options.name = "scans";
  EXPECT_EQ(OpenPosebench(options)->Read(0).file.scene, "scans");
}

TEST_F(Posebench, WhatIsBrokenIsNamedByFileAndGroup) {
  const auto drop = [](const char* name) { return [=](hid_t file) { H5Ldelete(file, name, H5P_DEFAULT); }; };
  const auto put = [](const char* name, const std::vector<hsize_t>& shape, double value) {
    return [=](hid_t file) {
      H5Ldelete(file, name, H5P_DEFAULT);
      hsize_t count = 1;
      for (const hsize_t length : shape) count *= length;
      PutNumbers(file, name, shape, std::vector<double>(count, value));
    };
  };
  const std::string place = "changed.h5: group 'a': ";
  EXPECT_TRUE(Refuses(drop("a/x1"), {place + "x1 is not there"}));
  EXPECT_TRUE(Refuses(drop("a/camera2"), {place + "camera2 is not there"}));
  EXPECT_TRUE(Refuses(drop("a/camera2/params"), {place + "camera2: params is not there"}));
  EXPECT_TRUE(Refuses(drop("b-pair_2.jpg/R"), {"group 'b-pair_2.jpg': R is not there"}));
  EXPECT_TRUE(Refuses(put("a/x1", {kMatches, 3}, 1.0), {place + "x1 is not of N x 2 numbers"}));
  EXPECT_TRUE(Refuses(put("a/x1", {2 * kMatches}, 1.0), {place + "x1 is not of N x 2 numbers"}));
  EXPECT_TRUE(Refuses(put("a/x1", {2, 2, 2}, 1.0), {place + "x1 has 3 dimensions"}));
  EXPECT_TRUE(Refuses(put("a/x2", {3, 2}, 1.0), {place + "x1 holds 40 points, x2 3"}));
  EXPECT_TRUE(
      Refuses(put("a/x2", {kMatches, 2}, std::nan("")), {place + "x2 holds a number that is not finite"}));
  EXPECT_TRUE(Refuses(put("a/R", {3, 3}, 1.0), {place + "R is not a rotation"}));
  EXPECT_TRUE(Refuses(put("a/R", {4, 3}, 1.0), {place + "R holds 12 numbers; 9 are needed"}));
  EXPECT_TRUE(Refuses(put("a/camera1/model", {1}, 1.0), {place + "camera1: model is not one short text"}));
  EXPECT_TRUE(Refuses(put("a/camera1/width", {1}, 0.5), {place + "camera1: width is 0.5; a whole number"}));
  EXPECT_TRUE(Refuses(put("a/camera1/params", {3}, 1.0), {place + "camera1: params holds 3 numbers; 4 are"}));
  EXPECT_TRUE(Refuses(put("a/camera1/params", {4}, 0.0), {place + "camera1: fx 0", "are not a camera"}));
  EXPECT_TRUE(Refuses([](hid_t file) { PutNumbers(file, "c", {1}, {1.0}); }, {"group 'c': is not a group"}));
  const auto text_for_x1 = [](hid_t file) {
    H5Ldelete(file, "a/x1", H5P_DEFAULT);
    PutText(file, "a/x1", "1 2", true);
  };
  EXPECT_TRUE(Refuses(text_for_x1, {place + "x1 does not hold numbers of up to 64 bits"}));
  const auto unknown_model = [](hid_t file) {
    H5Ldelete(file, "a/camera1/model", H5P_DEFAULT);
    PutText(file, "a/camera1/model", "FOV", false);
  };
  EXPECT_TRUE(Refuses(unknown_model, {place + "camera1: model 'FOV' is not supported"}));
}

// Links in circles and out of the file, and a dataset of 16 TB, of which nothing was written.
TEST_F(Posebench, LinksAndClaimsAreNotFollowed) {
  EXPECT_TRUE(Refuses([](hid_t file) { H5Lcreate_hard(file, "/", file, "loop", H5P_DEFAULT, H5P_DEFAULT); },
                      {"group 'loop': x1 is not there"}));
  EXPECT_TRUE(Refuses([](hid_t file) { H5Lcreate_soft("/soft", file, "soft", H5P_DEFAULT, H5P_DEFAULT); },
                      {"group 'soft': soft is a link to elsewhere"}));
  EXPECT_TRUE(Refuses(
      [](hid_t file) { H5Lcreate_external("/etc/passwd", "/", file, "out", H5P_DEFAULT, H5P_DEFAULT); },
      {"group 'out': out is a link to elsewhere"}));
  const auto huge = [](hid_t file) {
    H5Ldelete(file, "a/x1", H5P_DEFAULT);
    const hsize_t shape[] = {hsize_t{1} << 40, 2}, chunk[] = {1024, 2};
    const hid_t space = H5Screate_simple(2, shape, nullptr), how = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(how, 2, chunk);
    H5Dclose(H5Dcreate2(file, "a/x1", H5T_IEEE_F64LE, space, H5P_DEFAULT, how, H5P_DEFAULT));
    H5Pclose(how);
    H5Sclose(space);
  };
  EXPECT_TRUE(Refuses(huge, {"x1 holds more than 2000000 numbers"}));
}

hid_t MakeSpace(const std::vector<hsize_t>& shape, const std::vector<hsize_t>& most = {}) {
  return H5Screate_simple(static_cast<int>(shape.size()), shape.data(), most.empty() ? nullptr : most.data());
}

// A dataset a/x1 of 64-bit numbers in the place of that of the file; `how` is closed.
void PutX1(hid_t file, hid_t space, hid_t how, const std::vector<double>& values = {}) {
  H5Ldelete(file, "a/x1", H5P_DEFAULT);
  const hid_t data = H5Dcreate2(file, "a/x1", H5T_IEEE_F64LE, space, H5P_DEFAULT, how, H5P_DEFAULT);
  ASSERT_GE(data, 0);
  if (!values.empty()) H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Dclose(data);
  H5Pclose(how);
  H5Sclose(space);
}

// The bytes of another file, by each of the ways that the format has.
TEST_F(Posebench, NoOtherFileIsRead) {
  const std::string secret = folder_.Write("secret", std::string(4096, 's'));
  const auto external = [&](hid_t file) {
    const hid_t how = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_external(how, secret.c_str(), 0, 2 * kMatches * sizeof(double));
    PutX1(file, MakeSpace({kMatches, 2}), how);
  };
  EXPECT_TRUE(Refuses(external, {"group 'a': x1 is kept in another file, and no other file is read"}));
  const auto from_another = [&](hid_t file) {
    const hid_t how = H5Pcreate(H5P_DATASET_CREATE), space = MakeSpace({kMatches, 2});
    H5Pset_virtual(how, space, path_.c_str(), "/a/x2", space);
    PutX1(file, space, how);
  };
  EXPECT_TRUE(Refuses(from_another, {"group 'a': x1 is kept in another file, and no other file is read"}));
  const auto outward = [&](hid_t file) {
    H5Ldelete(file, "a/camera1", H5P_DEFAULT);
    H5Lcreate_external(path_.c_str(), "/a/camera1", file, "a/camera1", H5P_DEFAULT, H5P_DEFAULT);
  };
  EXPECT_TRUE(Refuses(outward, {"group 'a': camera1 is a link to elsewhere"}));
}

TEST_F(Posebench, PackedNumbersAreReadWhereTheyUnpackToLittle) {
  std::vector<double> x1;
  for (const Correspondence& match : observed_.matches)
    x1.insert(x1.end(), {match.x1_px.x(), match.x1_px.y()});
  const auto pack = [](const std::vector<hsize_t>& chunk) {
    const hid_t how = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(how, 2, chunk.data());
    H5Pset_shuffle(how);
    H5Pset_deflate(how, 9);
    H5Pset_fletcher32(how);
    return how;
  };
  const std::string copy = folder_.Path("packed.h5");
  std::filesystem::copy_file(path_, copy);
  const hid_t file = H5Fopen(copy.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  PutX1(file, MakeSpace({kMatches, 2}), pack({16, 2}), x1);
  H5Fclose(file);
  DatasetOptions options;
  options.folder = copy;
  const Eigen::Vector2d first = OpenPosebench(options)->Read(0).file.matches.at(0).x1_px;
  EXPECT_LT((first - observed_.matches[0].x1_px + Eigen::Vector2d(0.5, 0.5)).norm(), 1e-12);

  // A chunk of 1.6 GB for 40 points, and 16 MB of zeros in 16 kB.
  const auto chunk = [&](hid_t changed) {
    PutX1(changed, MakeSpace({kMatches, 2}, {H5S_UNLIMITED, 2}), pack({100'000'000, 2}));
  };
  EXPECT_TRUE(
      Refuses(chunk, {"x1 takes 0 bytes and would unpack to 1600000000; up to 100 times as many are read"}));
  const auto zeros = [&](hid_t changed) {
    PutX1(changed, MakeSpace({1'000'000, 2}), pack({100'000, 2}), std::vector<double>(2'000'000));
  };
  EXPECT_TRUE(Refuses(zeros, {"x1 takes ", "and would unpack to 16000000"}));
  const auto by_another_filter = [](hid_t changed) {
    const hid_t how = H5Pcreate(H5P_DATASET_CREATE);
    const hsize_t rows[] = {16, 2};
    H5Pset_chunk(how, 2, rows);
    H5Pset_scaleoffset(how, H5Z_SO_FLOAT_DSCALE, 2);
    PutX1(changed, MakeSpace({kMatches, 2}), how, std::vector<double>(2 * kMatches, 1.0));
  };
  EXPECT_TRUE(
      Refuses(by_another_filter, {"x1 is packed by filter 6; gzip, shuffle and fletcher32 are read"}));
  EXPECT_TRUE(Refuses(
      [](hid_t changed) {
        H5Ldelete(changed, "a/x1", H5P_DEFAULT);
        PutNumbers(changed, "a/x1", {kMatches, 2}, std::vector<double>(2 * kMatches), H5T_NATIVE_LDOUBLE);
      },
      {"x1 does not hold numbers of up to 64 bits"}));
}

// 200,000 numbers, of which every 16th is random: packed to a tenth, but unpacked under twelve names.
TEST_F(Posebench, AGroupOfManyNamesIsNotUnpackedForEach) {
  RandomStream rng({.seed = 1, .purpose = 92});
  std::vector<double> numbers(200'000, 1.0);
  for (size_t i = 0; i < numbers.size(); i += 16) numbers[i] = rng.Uniform(0.0, 600.0);
  const auto repeat = [&](hid_t file) {
    for (const char* name : {"a/x1", "a/x2"}) {
      H5Ldelete(file, name, H5P_DEFAULT);
      const hid_t how = H5Pcreate(H5P_DATASET_CREATE), space = MakeSpace({numbers.size() / 2, 2});
      const hsize_t chunk[] = {10'000, 2};
      H5Pset_chunk(how, 2, chunk);
      H5Pset_deflate(how, 9);
      const hid_t data = H5Dcreate2(file, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, how, H5P_DEFAULT);
      H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data());
      H5Dclose(data);
      H5Sclose(space);
      H5Pclose(how);
    }
    for (int i = 0; i < 30; ++i)
      H5Lcreate_hard(file, "a", file, fmt::format("a{:02}", i).c_str(), H5P_DEFAULT, H5P_DEFAULT);
  };
  EXPECT_TRUE(Refuses(repeat, {"the file's pairs so far unpack to more than a hundred times its size"}));
}

// Files by which libhdf5 1.10.8 ends with a segmentation fault or not at all: each is an error that names it,
// or is read.
TEST_F(Posebench, FilesThatCrashTheLibraryAreErrors) {
  const std::string crashes = SourceFolder() + "/tests/fuzz/corpus/posebench";
  int num_files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(crashes)) {
    ++num_files;
    try {
      ReadAll(entry.path().string());
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find(entry.path().string()), 0u) << error.what();
    }
  }
  EXPECT_GE(num_files, 2);
}

// 200 files with some bytes changed. Whatever the library does of them, the process is still there.
TEST_F(Posebench, FilesWithChangedBytesAreReadOrRefused) {
  const std::string whole = ReadBytes(path_);
  RandomStream rng({.seed = 1, .purpose = 93});
  int num_refused = 0;
  for (int k = 0; k < 200; ++k) {
    std::string bytes = whole;
    for (int i = 0; i < 1 + k % 8; ++i)
      bytes[static_cast<size_t>(rng.Uniform(0.0, 1.0) * static_cast<double>(bytes.size()))] =
          static_cast<char>(rng.Uniform(0.0, 256.0));
    const std::string path = folder_.Write("changed.h5", bytes);
    try {
      ReadAll(path);
    } catch (const InputError& error) {
      ++num_refused;
      EXPECT_EQ(std::string(error.what()).find(path), 0u) << error.what();
    }
  }
  EXPECT_GT(num_refused, 20);
}

TEST_F(Posebench, FilesThatAreCutOffOrNone) {
  const std::string whole = ReadBytes(path_);
  for (const size_t size : {whole.size() / 2, whole.size() - 1, size_t{100}, size_t{0}})
    EXPECT_TRUE(ThrowsInputError([&] { ReadAll(folder_.Write("cut.h5", whole.substr(0, size))); },
                                 {"cut.h5: cannot be read as an HDF5 file"}))
        << size;
  EXPECT_TRUE(ThrowsInputError([&] { ReadAll(folder_.Path("none.h5")); }, {"none.h5: is not there"}));
  const hid_t empty = H5Fcreate(folder_.Path("empty.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  H5Fclose(empty);
  EXPECT_TRUE(ThrowsInputError([&] { ReadAll(folder_.Path("empty.h5")); }, {"empty.h5: holds no pairs"}));
}

}  // namespace
}  // namespace rcme
