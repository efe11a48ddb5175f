#include "estimator/instruction_set.h"

#include <gmock/gmock.h>

#include <vector>

#include "tests/test_support/every_target.h"

namespace rcme {
namespace {

class InstructionSet : public OnEveryTarget {};

// Would catch the name of the machine's best set in place of the one in use.
TEST_F(InstructionSet, NamesTheOneInUse) {
  std::vector<std::string> expected = {"scalar"}, names;
  if (hwy::SupportedTargets() & HWY_AVX2) expected.emplace_back("AVX2");
  if (hwy::SupportedTargets() & HWY_AVX3) expected.emplace_back("AVX-512");
  Run([&] { names.push_back(InstructionSetName()); });
  EXPECT_THAT(names, testing::ElementsAreArray(expected));
}

}  // namespace
}  // namespace rcme
