#include "simulator/noise_registry.h"

#include "simulator/noise/noise_laws.h"

namespace rcme {

const std::vector<NoiseEntry>& NoiseRegistry() {
  static const std::vector<NoiseEntry> registry = {
      {"gaussian", "normal, independent, equal in all coordinates (the paper's a.2)",
       [] { return MakeGaussianNoise(); }},
      {"anisotropic", "normal, larger along one axis, optionally correlated between the images",
       MakeAnisotropicNoise},
      {"octave", "normal, larger on coarser levels of an image pyramid", MakeOctaveNoise},
      {"student_t", "Student's t in every coordinate", MakeStudentNoise},
      {"laplace", "double exponential in every coordinate", MakeLaplaceNoise},
      {"contaminated", "normal, several times larger in a share of the matches", MakeContaminatedNoise},
      {"correlated", "correlated between neighbours in an image; normal or Student's t", MakeCorrelatedNoise},
      {"duplicated", "normal; some points are matched several times, with correlated errors",
       MakeDuplicatedNoise},
      {"displacement_field", "normal, in part a field over each image", MakeDisplacementFieldNoise},
      {"quantised", "normal, then rounded to the detector's grid", MakeQuantisedNoise},
  };
  return registry;
}

}  // namespace rcme
