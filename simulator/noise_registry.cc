#include "simulator/noise_registry.h"

#include "simulator/noise/noise_laws.h"

namespace rcme {

const std::vector<NoiseEntry>& NoiseRegistry() {
  static const std::vector<NoiseEntry> registry = {
      {"gaussian", "independent and normal, equal in all coordinates (the paper's a.2)",
       [] { return MakeGaussianNoise(); }},
      {"anisotropic", "normal, larger along one axis, correlated between x and y or between the images",
       MakeAnisotropicNoise},
      {"octave", "normal, larger for points from coarser levels of an image pyramid", MakeOctaveNoise},
      {"student_t", "Student's t in every coordinate: heavy tails", MakeStudentNoise},
      {"laplace", "double exponential in every coordinate", MakeLaplaceNoise},
      {"contaminated", "normal, several times as large in a share of the matches", MakeContaminatedNoise},
      {"correlated", "errors that neighbours in an image have in common; normal, or with tails",
       MakeCorrelatedNoise},
      {"duplicated", "normal; some points are matched several times, with errors that are much alike",
       MakeDuplicatedNoise},
      {"displacement_field", "normal; a share of it is a field of displacements over each image",
       MakeDisplacementFieldNoise},
      {"quantised", "normal, then rounded to the detector's grid: larger than what sigma_px says",
       MakeQuantisedNoise},
  };
  return registry;
}

}  // namespace rcme
