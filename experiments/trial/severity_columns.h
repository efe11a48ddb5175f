// The columns of the result file, and those of a problem's severity.
#pragma once

#include <limits>

#include "simulator/severity/severity.h"

namespace rcme {

// The allowed values of a numeric column; by default all values of its type.
struct ColumnRange {
  double min = -std::numeric_limits<double>::infinity(), max = std::numeric_limits<double>::infinity();
  bool may_be_unknown = true;  // NaN, stored as NULL; whole numbers are always known

  bool Contains(double value) const { return value >= min && value <= max; }
};

// Only numbers on which estimators have no influence are limited; what an estimator reports about itself may
// be anything.
inline constexpr ColumnRange kAnyNumber = {};
inline constexpr ColumnRange kNotNegative = {0.0};
inline constexpr ColumnRange kFromZeroToOne = {0.0, 1.0};
inline constexpr ColumnRange kAngleDeg = {0.0, 180.0};
inline constexpr ColumnRange kFiniteOrUnknown = {0.0, std::numeric_limits<double>::max()};
inline constexpr ColumnRange kFiniteAndKnown = {0.0, std::numeric_limits<double>::max(), false};

// Describes a column of the result file. Its storage, the check of values that are read, the documentation,
// the CSV of trials and Python's data frame all use this description.
struct StoredColumn {
  // kTime: differs in every run, so comparisons of trials leave it out.
  enum class Role { kKey, kNumber, kTime };

  const char* name;
  const char* unit;  // empty: no unit
  const char* meaning;
  ColumnRange range = kAnyNumber;
  Role role = Role::kNumber;
};

// The columns of a problem's severity, for tables and printing.
struct SeverityColumn : StoredColumn {
  double Severity::*field;
};

inline constexpr SeverityColumn kSeverityColumns[] = {
    {{"image_coverage", "share", "part of image 1 in the hull of the true matches"},
     &Severity::image_coverage},
    {{"inlier_clark_evans", "", "Clark-Evans index of true matches in image 1: 1 random, below 1 clustered"},
     &Severity::inlier_clark_evans},
    {{"outlier1_clark_evans", "", "the same for wrong matches"}, &Severity::outlier1_clark_evans},
    {{"outlier2_clark_evans", "", "the same for wrong matches in image 2"}, &Severity::outlier2_clark_evans},
    {{"parallax_median_deg", "deg", "median angle between the rays to both cameras", kAngleDeg},
     &Severity::parallax_median_deg},
    {{"parallax_p10_deg", "deg", "their 10th percentile", kAngleDeg}, &Severity::parallax_p10_deg},
    {{"planarity", "", "rms distance of points from their plane over that from their centroid"},
     &Severity::planarity},
    {{"homography_share", "share", "true matches that one homography explains", kFromZeroToOne},
     &Severity::homography_share},
    {{"log10_condition", "", "condition of the motion's information matrix (5x5, rad)"},
     &Severity::log10_condition},
    {{"crb_rotation_deg", "deg", "Cramer-Rao bound of the rms rotation error", kNotNegative},
     &Severity::crb_rotation_deg},
    {{"crb_direction_deg", "deg", "the same for the direction of translation", kNotNegative},
     &Severity::crb_direction_deg},
    {{"chance_inlier_share", "share", "uniform wrong matches that the true motion accepts at 95 %",
      kNotNegative},
     &Severity::chance_inlier_share},
    {{"undetectable_share", "share", "wrong matches on the true epipolar line", kFromZeroToOne},
     &Severity::undetectable_share}};

}  // namespace rcme
