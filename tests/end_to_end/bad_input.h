// What the program says to something wrong, and a folder with a small study to say it of.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/test_support/run_program.h"
#include "tests/test_support/small_study.h"

namespace rcme {

// Whether the program ended with 2 and its standard error holds every fragment.
inline testing::AssertionResult IsRefused(const ProgramResult& result,
                                          const std::vector<std::string>& fragments) {
  const auto fail = [&](const std::string& why) {
    return testing::AssertionFailure()
           << why << "; exit code " << result.exit_code << ", standard error: " << result.err;
  };
  if (result.exit_code != 2) return fail("the exit code is not 2");
  for (const std::string& fragment : fragments) {
    if (result.err.find(fragment) == std::string::npos)
      return fail("the error does not say '" + fragment + "'");
  }
  if (result.err.find("internal error") != std::string::npos) return fail("called an internal error");
  return testing::AssertionSuccess();
}

class BadInput : public testing::Test {
 protected:
  ProgramResult Estimate(const std::string& name, const std::string& bytes) {
    return RunRcme({"estimate", folder_.Write(name, bytes), "--format=json"});
  }
  ProgramResult Run(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"run", study_, "--threads", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunRcme(arguments);
  }

  TempFolder folder_;
  std::string study_ = folder_.Write("small.yaml", SmallStudyYaml());
  std::string out_ = folder_.Path("run.sqlite");
};

}  // namespace rcme
