// Readers for the download layouts of data sets of image sequences, one per file. They throw InputError that
// names a path for anything missing, damaged or contradictory.
#pragma once

#include <vector>

#include "experiments/real/sequences/sequence.h"

namespace rcme {

// sequences/NN/{image_0/000000.png, calib.txt, times.txt} and, for 00 to 10, poses/NN.txt: camera 0 of the
// KITTI odometry benchmark (Geiger, Lenz & Urtasun 2012), rectified.
std::vector<Sequence> ReadKitti(const DatasetOptions& options);

// NAME/mav0/{cam0/{data.csv, data/*.png, sensor.yaml}, state_groundtruth_estimate0/data.csv}: the left
// camera of the EuRoC MAV data set (Burri et al. 2016). Its truth is that of the body and is interpolated.
std::vector<Sequence> ReadEuroc(const DatasetOptions& options);

// NAME/{rgb.txt, rgb/*.png, groundtruth.txt}: the TUM RGB-D benchmark (Sturm et al. 2012). Its cameras are
// on its web page, not in the folder: they are known here if the folder name contains freiburg1, 2 or 3,
// otherwise they must be given.
std::vector<Sequence> ReadTum(const DatasetOptions& options);

// *.png, *.jpg, ... of one folder, ordered by name, with a given K. There are no times and no truth.
std::vector<Sequence> ReadImageFolder(const DatasetOptions& options);

}  // namespace rcme
