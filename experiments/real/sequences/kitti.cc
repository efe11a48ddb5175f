#include <fmt/format.h>

#include <Eigen/LU>

#include "experiments/real/sequences/layout_files.h"
#include "experiments/real/sequences/layouts.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

namespace fs = std::filesystem;

// Reads a 3x4 matrix from 12 numbers, row by row, beginning at field `first`.
Eigen::Matrix<double, 3, 4> MatrixIn(const TableFile& table, size_t first) {
  table.Need(first + 12, "a 3x4 matrix, row by row");
  Eigen::Matrix<double, 3, 4> matrix;
  for (size_t i = 0; i < 12; ++i)
    matrix(static_cast<int>(i / 4), static_cast<int>(i % 4)) = table.Number(first + i);
  return matrix;
}

// Parses "P0: fx 0 cx 0 0 fy cy 0 0 0 1 0".
Lens KittiLens(const fs::path& path) {
  TableFile table(path, "it is part of the calibration files (data_odometry_calib.zip)",
                  TableFile::Separator::kSpace);
  while (table.Next()) {
    if (table.fields().front() != "P0:") continue;
    const Eigen::Matrix<double, 3, 4> P = MatrixIn(table, 1);
    if (P(0, 1) != 0.0 || P(1, 0) != 0.0 || P.row(2) != Eigen::RowVector4d(0.0, 0.0, 1.0, 0.0) ||
        P.col(3).norm() > 0.0)
      table.Fail("P0 is not of the form fx 0 cx 0 0 fy cy 0 0 0 1 0");
    return MakeLens({P(0, 0), P(1, 1), P(0, 2), P(1, 2), 0, 0}, LensModel::kPinhole, {},
                    path.string() + ": P0");
  }
  throw InputError(fmt::format("{}: has no line 'P0: ...'", path.string()));
}

std::vector<CameraPose> KittiPoses(const fs::path& path) {
  std::vector<CameraPose> poses;
  for (TableFile table(path, "", TableFile::Separator::kSpace); table.Next();) {
    const Eigen::Matrix<double, 3, 4> world_from_cam = MatrixIn(table, 0);
    const Eigen::Matrix3d R = world_from_cam.leftCols<3>();
    if (!((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-3) || R.determinant() < 0.0)
      table.Fail("the matrix does not begin with a rotation");
    poses.push_back({R, world_from_cam.col(3)});
  }
  return poses;
}

Sequence KittiSequence(const DatasetOptions& options, const fs::path& root, const fs::path& folder) {
  const fs::path times = folder / "times.txt", poses = root / "poses" / (FolderName(folder) + ".txt");
  Sequence sequence;
  sequence.name = (options.name.empty() ? "kitti_" : options.name) + FolderName(folder);
  sequence.lens = KittiLens(folder / "calib.txt");
  const auto image = [](size_t i) { return fmt::format("image_0/{:06}.png", i); };
  for (TableFile table(times, "it comes with the images", TableFile::Separator::kSpace,
                       TableFile::kMaxImages);
       table.Next();) {
    const std::string name = image(sequence.frames.size());
    sequence.frames.push_back({name, (folder / name).string(), table.Number(0), std::nullopt});
  }
  const size_t num_times = sequence.frames.size();
  if (fs::exists(folder / image(num_times))) {
    throw InputError(fmt::format("{}: has {} lines, and there is an image {}: one line per image is needed",
                                 times.string(), num_times, image(num_times)));
  }
  if (fs::exists(poses)) {
    const std::vector<CameraPose> truth = KittiPoses(poses);
    if (truth.size() != num_times)
      throw InputError(fmt::format("{}: has {} poses; {} has {} times", poses.string(), truth.size(),
                                   times.string(), num_times));
    for (size_t i = 0; i < num_times; ++i) sequence.frames[i].pose_true = truth[i];
  } else {
    sequence.note =
        fmt::format("no truth: {} is not there (data_odometry_poses.zip has 00 to 10)", poses.string());
  }
  FinishSequence(options, times, &sequence);
  return sequence;
}

}  // namespace

std::vector<Sequence> ReadKitti(const DatasetOptions& options) {
  fs::path root(options.folder);
  if (!fs::exists(root / "sequences") && fs::exists(root / "dataset")) root /= "dataset";
  DatasetOptions in_sequences = options;
  CheckIsThere(root, "give the folder of the data set");
  CheckIsThere(root / "sequences",
               "the archives of KITTI odometry unpack to dataset/sequences and dataset/poses");
  in_sequences.folder = (root / "sequences").string();
  std::vector<Sequence> sequences;
  for (const fs::path& folder : SequenceFolders(
           in_sequences, "image_0", "no subfolder NN/image_0 is in it either (data_odometry_gray.zip)"))
    sequences.push_back(KittiSequence(options, root, folder));
  return sequences;
}

}  // namespace rcme
