// The layouts that data sets of image sequences are downloaded in, a file each. Each throws InputError that
// names a path for what is missing, damaged or contradicts itself.
#pragma once

#include <string>
#include <vector>

#include "experiments/real/sequences/sequence.h"

namespace rcme {

// sequences/NN/{image_0/000000.png, calib.txt, times.txt} and, for 00 to 10, poses/NN.txt: camera 0 of the
// KITTI odometry benchmark (Geiger, Lenz & Urtasun 2012), rectified.
std::vector<Sequence> ReadKitti(const DatasetOptions& options);

// NAME/mav0/{cam0/{data.csv, data/*.png, sensor.yaml}, state_groundtruth_estimate0/data.csv}: the left camera
// of the EuRoC MAV data set (Burri et al. 2016), whose truth is that of the body and is taken between its
// samples.
std::vector<Sequence> ReadEuroc(const DatasetOptions& options);

// NAME/{rgb.txt, rgb/*.png, groundtruth.txt}: the TUM RGB-D benchmark (Sturm et al. 2012). Its cameras are on
// its page and not in the folder: known here by freiburg1, 2 or 3 in the folder's name, else to be given.
std::vector<Sequence> ReadTum(const DatasetOptions& options);

// *.png, *.jpg, ... of one folder in the order of names, with K given: no times and no truth.
std::vector<Sequence> ReadImageFolder(const DatasetOptions& options);

}  // namespace rcme
