#include <cmath>
#include <cstdlib>

#include "estimator/conform/conform_file.h"
#include "tests/fuzz/harness/only_input_error.h"

namespace rcme {
namespace {

// A rule that is read judges any answer, and is written and read again as it is.
void ReadTwice(const std::string& text) {
  const ConformRule rule = ParseConformFile(text, "x.json").rule;
  const std::string written = ConformFileText(rule, {});
  if (ConformFileText(ParseConformFile(written, "again.json").rule, {}) != written) std::abort();
  const ConformJudge judge(rule);
  for (const double x : {-1e9, 0.0, 1e9, std::nan("")}) {
    VisibleFeatures features;
    features.fill(x);
    const ConformVerdict verdict = judge.Judge(features);
    if (std::isnan(verdict.factor) || verdict.factor < 0.0) std::abort();
    if (!(verdict.failure_probability >= 0.0 && verdict.failure_probability <= 1.0)) std::abort();
    if (!(verdict.familiarity > 0.0 && verdict.familiarity <= 1.0)) std::abort();
  }
}

}  // namespace
}  // namespace rcme

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  using namespace rcme;
  OnlyInputError([&] { ReadTwice(AsText(data, size)); });
  return 0;
}
