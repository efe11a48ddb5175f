#include "experiments/data/camera_plausibility.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "parameters/input_error.h"
#include "stats/constants.h"

namespace rcme {
namespace {

// Share of the longer side. Crops to a strip move the principal point by up to .12 (the side cameras of
// Waymo), half a K by .25.
constexpr double kFarFromCentre = 0.2;
// Share of width and height: as far as a sensor is mounted off the axis of its lens.
constexpr double kNearCentre = 0.1;
// fx / fy of square and of other pixels; 1080-line anamorphic video has 1.33.
constexpr double kSquarePixels = 1.1, kOddPixels = 1.2, kLongestPixel = 2.0;
// Tangents of the angle from the axis to a corner: 71.6 degrees, more than any pinhole image shows, and
// 89.4.
constexpr double kWideCorner = 3.0, kImpossibleCorner = 100.0;
// Focal length over the longer side: an angle of view of 1.9 degrees.
constexpr double kLongLens = 30.0;

using Numbers = std::array<double, 4>;  // fx fy cx cy

// The offset of the principal point from the centre, over width and height.
Eigen::Vector2d ComputeOffset(const Numbers& K, const Eigen::Vector2d& size) {
  return {(K[2] + 0.5) / size.x() - 0.5, (K[3] + 0.5) / size.y() - 0.5};
}

// max(fx / fy, fy / fx).
double ComputePixelLength(const Numbers& K) { return std::max(K[0] / K[1], K[1] / K[0]); }

// The tangent of the largest angle between the axis and a corner.
double ComputeCornerTangent(const Numbers& K, const Eigen::Vector2d& size) {
  const double x = std::max(K[2] + 0.5, size.x() - 0.5 - K[2]),
               y = std::max(K[3] + 0.5, size.y() - 0.5 - K[3]);
  return std::hypot(x / K[0], y / K[1]);
}

bool IsFarFromCentre(const Numbers& K, const Eigen::Vector2d& size) {
  return ComputeOffset(K, size).cwiseProduct(size).cwiseAbs().maxCoeff() > kFarFromCentre * size.maxCoeff();
}

// Returns whether K has square pixels, a principal point near the centre and an ordinary angle of view.
bool IsOrdinary(const Numbers& K, const Eigen::Vector2d& size, double near) {
  return K[0] > 0.0 && K[1] > 0.0 && ComputePixelLength(K) < kSquarePixels &&
         ComputeOffset(K, size).cwiseAbs().maxCoeff() < near && ComputeCornerTangent(K, size) < kWideCorner;
}

// Returns another order in which the numbers are those of an ordinary camera.
std::optional<std::string> FindOrder(const Numbers& K, const Eigen::Vector2d& size, double near) {
  constexpr std::array<std::pair<const char*, std::array<size_t, 4>>, 3> kOrders = {
      {{"cx cy fx fy", {2, 3, 0, 1}}, {"fx cx fy cy", {0, 2, 1, 3}}, {"cx fx cy fy", {1, 3, 0, 2}}}};
  for (const auto& [name, at] : kOrders) {
    if (IsOrdinary({K[at[0]], K[at[1]], K[at[2]], K[at[3]]}, size, near)) return name;
  }
  return std::nullopt;
}

std::string DescribeSize(const Eigen::Vector2d& size) {
  return fmt::format("{:.0f} x {:.0f} px", size.x(), size.y());
}

std::string DescribeOrder(const std::string& order) {
  return fmt::format("the numbers look like {} and are read as fx fy cx cy; give them in that order", order);
}

// Detects K of the image in another size: its principal point is the centre of that image.
std::optional<std::string> DoubtScale(const Eigen::Vector2d& offset, const Eigen::Vector2d& size) {
  constexpr double kLeast = 0.06, kSame = 0.04;
  if (std::min(std::abs(offset.x()), std::abs(offset.y())) < kLeast ||
      std::abs(offset.x() - offset.y()) > kSame)
    return std::nullopt;
  const double scale = 1.0 + offset.x() + offset.y();
  return fmt::format(
      "the principal point is the centre of an image of {}, the image has {}; if it was scaled, divide "
      "fx, fy, cx and cy by about {:.2f}",
      DescribeSize(scale * size), DescribeSize(size), scale);
}

// Detects K of the image before a rotation by 90 degrees.
std::optional<std::string> DoubtTurn(const Numbers& K, const Eigen::Vector2d& offset,
                                     const Eigen::Vector2d& size) {
  constexpr double kNear = 0.05;
  const Eigen::Vector2d turned(size.y(), size.x());
  if (ComputeOffset(K, turned).cwiseAbs().maxCoeff() > kNear || offset.cwiseAbs().minCoeff() < kNearCentre)
    return std::nullopt;
  return fmt::format(
      "the principal point is the centre of an image of {}, the image has {}; if it was turned, give K "
      "of the turned image",
      DescribeSize(turned), DescribeSize(size));
}

std::optional<std::string> DoubtPrincipalPoint(const Numbers& K, const Eigen::Vector2d& size) {
  const Eigen::Vector2d offset = ComputeOffset(K, size);
  if (auto doubt = DoubtTurn(K, offset, size)) return doubt;
  if (auto doubt = DoubtScale(offset, size)) return doubt;
  if (!IsFarFromCentre(K, size)) return std::nullopt;
  return fmt::format(
      "the principal point ({:.6g}, {:.6g}) is far from the centre of the image of {}; unless the image "
      "was cut out of a larger one, K is of other images",
      K[2], K[3], DescribeSize(size));
}

std::optional<std::string> DoubtOrder(const Numbers& K, const Eigen::Vector2d& size) {
  if (!IsFarFromCentre(K, size)) return std::nullopt;
  const std::optional<std::string> order = FindOrder(K, size, kNearCentre);
  if (!order) return std::nullopt;
  return DescribeOrder(*order);
}

std::vector<std::string> DoubtFocalLength(const Numbers& K, const Eigen::Vector2d& size, LensModel model) {
  std::vector<std::string> doubts;
  const double corner = ComputeCornerTangent(K, size), focal = std::max(K[0], K[1]);
  if (corner > kWideCorner && model != LensModel::kFisheye)
    doubts.push_back(
        fmt::format("with fx = {:.6g} a corner of the image of {} is {:.1f} degrees off the axis; no "
                    "pinhole image shows that much, so check that fx and fy are in px",
                    K[0], DescribeSize(size), kDegPerRad * std::atan(corner)));
  if (focal > kLongLens * size.maxCoeff())
    doubts.push_back(
        fmt::format("with fx = {:.6g} the image of {} shows {:.2f} degrees; check that fx and fy are in px "
                    "of this image",
                    K[0], DescribeSize(size), kDegPerRad * size.maxCoeff() / focal));
  if (ComputePixelLength(K) > kLongestPixel)
    doubts.push_back(
        fmt::format("fx = {:.6g} and fy = {:.6g} differ by more than a factor of two; the order is fx fy "
                    "cx cy",
                    K[0], K[1]));
  return doubts;
}

// Throws if K is certainly wrong.
void CheckPossible(const Numbers& K, const Eigen::Vector2d& size, const std::string& place, LensModel model) {
  const std::string given = fmt::format("{}: {:.6g} {:.6g} {:.6g} {:.6g}", place, K[0], K[1], K[2], K[3]);
  const bool is_outside = ComputeOffset(K, size).cwiseAbs().maxCoeff() > 0.5;
  const std::optional<std::string> order = FindOrder(K, size, kNearCentre);
  if (order && (is_outside || ComputePixelLength(K) > kOddPixels))
    throw InputError(
        fmt::format("{} in an image of {}: {}", given, DescribeSize(size), DescribeOrder(*order)));
  if (ComputeCornerTangent(K, size) > kImpossibleCorner && model != LensModel::kFisheye)
    throw InputError(
        fmt::format("{} in an image of {}: a corner would be more than 89 degrees off the axis; give fx, "
                    "fy, cx and cy in px, not in mm or in shares of the image",
                    given, DescribeSize(size)));
  if (is_outside)
    throw InputError(
        fmt::format("{}: the principal point is outside of the image of {}; K and image are of different "
                    "sizes, or the order is not fx fy cx cy; of an image cut out of a larger one give "
                    "size, K and key points of the larger one",
                    given, DescribeSize(size)));
}

// The range of the central 95 % of the points, by coordinate.
struct PointSpread {
  Eigen::Vector2d least, greatest;
};
PointSpread MeasureSpread(const std::vector<Correspondence>& matches, Eigen::Vector2d Correspondence::*x_px) {
  PointSpread spread;
  std::vector<double> values(matches.size());
  const auto quantile = [&](double share) {
    const auto at =
        values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
  };
  for (int i = 0; i < 2; ++i) {
    std::ranges::transform(matches, values.begin(),
                           [&](const Correspondence& match) { return (match.*x_px)[i]; });
    spread.least[i] = quantile(0.025);
    spread.greatest[i] = quantile(0.975);
  }
  return spread;
}

}  // namespace

std::vector<InputDoubt> FindCameraDoubts(const Camera& camera, const std::string& place, LensModel model) {
  const Numbers K = {camera.fx, camera.fy, camera.cx, camera.cy};
  const Eigen::Vector2d size(camera.width, camera.height);
  CheckPossible(K, size, place, model);
  std::vector<InputDoubt> doubts;
  for (const std::string& what : DoubtFocalLength(K, size, model)) doubts.push_back({place, what});
  for (const auto& what : {DoubtPrincipalPoint(K, size), DoubtOrder(K, size)}) {
    if (what) doubts.push_back({place, *what});
  }
  return doubts;
}

std::vector<InputDoubt> FindKeyPointDoubts(const Camera& camera, const std::vector<Correspondence>& matches,
                                           Eigen::Vector2d Correspondence::*x_px, bool is_size_known,
                                           const std::string& place, LensModel model) {
  constexpr size_t kFewest = 10;
  constexpr double kBeyond = 1.25,
                   kBefore = 0.02;  // of the size; undistortion moves points outside on all sides
  if (matches.size() < kFewest) return {};
  const auto [least, greatest] = MeasureSpread(matches, x_px);
  const Eigen::Vector2d centre(camera.cx, camera.cy), implied = 2.0 * centre + Eigen::Vector2d::Ones();
  const Eigen::Vector2d size = is_size_known ? Eigen::Vector2d(camera.width, camera.height) : implied;
  std::vector<InputDoubt> doubts;
  if ((greatest.array() > kBeyond * size.array()).any() && (least.array() > -kBefore * size.array()).all())
    doubts.push_back(
        {place, fmt::format("key points lie far to the right of or below an image of {}, {}; K is of a "
                            "smaller image, unless this one was cut out of a larger one",
                            DescribeSize(size), is_size_known ? "its size" : "twice the principal point")});
  if (is_size_known) return doubts;
  if ((greatest.array() < centre.array()).all())
    doubts.push_back(
        {place, fmt::format("key points lie to the left of and above the principal point ({:.6g}, {:.6g}); "
                            "K is of a larger image, unless the matches are of one corner",
                            camera.cx, camera.cy)});
  const Eigen::Vector2d reach = (greatest - centre).cwiseAbs().cwiseMax((least - centre).cwiseAbs());
  if (const double tangent = std::hypot(reach.x() / camera.fx, reach.y() / camera.fy);
      tangent > kWideCorner && model != LensModel::kFisheye)
    doubts.push_back(
        {place, fmt::format("with fx = {:.6g} key points lie {:.1f} degrees off the axis; no pinhole "
                            "image shows that much, so check that fx, fy, cx and cy are in px",
                            camera.fx, kDegPerRad * std::atan(tangent))});
  const Numbers K = {camera.fx, camera.fy, camera.cx, camera.cy};
  if (const auto order = FindOrder(K, least + greatest, kFarFromCentre);
      order && ComputePixelLength(K) > kOddPixels)
    doubts.push_back({place, DescribeOrder(*order)});
  return doubts;
}

namespace {

// Both checks for one image. If the key points are outside of the stated size, but K fits them, the size is
// wrong, and what the checks say of K by that size is left out.
std::vector<InputDoubt> FindImageDoubts(const Camera& camera, const std::vector<Correspondence>& matches,
                                        Eigen::Vector2d Correspondence::*x_px, bool is_size_known,
                                        const std::string& place, LensModel model) {
  std::vector<InputDoubt> of_points = FindKeyPointDoubts(camera, matches, x_px, is_size_known, place, model);
  if (!is_size_known) return of_points;
  std::vector<InputDoubt> doubts = FindCameraDoubts(camera, place, model);
  if (!of_points.empty() && FindKeyPointDoubts(camera, matches, x_px, false, place, model).empty()) {
    const Eigen::Vector2d implied(2.0 * camera.cx + 1.0, 2.0 * camera.cy + 1.0);
    return {{place, fmt::format("key points lie far outside of an image of {}, its size, but fit K, whose "
                                "principal point is the centre of one of {}; correct the size",
                                DescribeSize({camera.width, camera.height}), DescribeSize(implied))}};
  }
  doubts.insert(doubts.end(), of_points.begin(), of_points.end());
  return doubts;
}

}  // namespace

namespace {

// Whether all key points of both images are so near (0, 0) that they are rays x/z, y/z, or of a unit square,
// while K is in px.
bool AreNormalised(const Camera& camera1, const Camera& camera2, const std::vector<Correspondence>& matches) {
  constexpr size_t kFewest = 8;
  constexpr double kMostPx = 5.0, kLeastFocalPx = 50.0;
  return matches.size() >= kFewest && std::min(camera1.fx, camera2.fx) >= kLeastFocalPx &&
         std::ranges::all_of(matches, [](const Correspondence& match) {
           return std::max(match.x1_px.cwiseAbs().maxCoeff(), match.x2_px.cwiseAbs().maxCoeff()) < kMostPx;
         });
}

}  // namespace

std::vector<InputDoubt> FindPairDoubts(const Camera& camera1, const Camera& camera2,
                                       const std::vector<Correspondence>& matches,
                                       const std::array<std::string, 2>& places,
                                       const std::array<bool, 2>& are_sizes_known,
                                       const std::array<LensModel, 2>& models) {
  if (AreNormalised(camera1, camera2, matches)) {
    return {{places[0],
             fmt::format("all key points are within 5 px of (0, 0), which with fx = {:.6g} do not look like "
                         "pixels; give x1,y1,x2,y2 in px (fx x + cx, fy y + cy of normalised coordinates)",
                         camera1.fx)}};
  }
  std::vector<InputDoubt> doubts =
      FindImageDoubts(camera1, matches, &Correspondence::x1_px, are_sizes_known[0], places[0], models[0]);
  for (const InputDoubt& doubt :
       FindImageDoubts(camera2, matches, &Correspondence::x2_px, are_sizes_known[1], places[1], models[1])) {
    const bool is_known =
        std::ranges::any_of(doubts, [&](const InputDoubt& d) { return d.what == doubt.what; });
    if (!is_known) doubts.push_back(doubt);
  }
  return doubts;
}

std::array<int, 2> LikelySize(const Camera& camera, const std::vector<Correspondence>& matches,
                              Eigen::Vector2d Correspondence::*x_px) {
  Eigen::Vector2d size(2.0 * camera.cx + 1.0, 2.0 * camera.cy + 1.0);
  for (const Correspondence& match : matches)
    size = size.cwiseMax((match.*x_px + Eigen::Vector2d::Constant(0.5)).eval());
  const auto whole = [](double length) {
    return static_cast<int>(std::clamp(std::ceil(length), 1.0, kMaxImageLength));
  };
  return {whole(size.x()), whole(size.y())};
}

}  // namespace rcme
