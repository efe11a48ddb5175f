// What a process of its own may not do.
#include "experiments/core/work/isolated_call.h"

#include <fcntl.h>
#include <gtest/gtest.h>

#include <csignal>
#include <new>
#include <vector>

namespace rcme {
namespace {

using Kind = IsolatedEnd::Kind;

TEST(IsolatedCall, ACrashIsAnOutcome) {
  const IsolatedEnd end = RunIsolated(
      [](const Announce&) -> std::string {
        std::signal(SIGSEGV, SIG_DFL);  // sanitizers have a handler
        raise(SIGSEGV);
        return "";
      },
      60.0);
  EXPECT_EQ(end.kind, Kind::kSignal);
  EXPECT_EQ(end.code, SIGSEGV);
  EXPECT_EQ(DescribeEnd(end, 60.0).find("ended the program by signal 11"), 0u);
}

TEST(IsolatedCall, MemoryIsLimitedBeyondWhatThereIs) {
  const auto take = [](size_t megabytes) {
    return RunIsolated(
        [=](const Announce&) -> std::string {
          LimitProcess(size_t{256} << 20, 60);
          try {
            const std::vector<char> taken(megabytes << 20, 'x');
            return taken.back() == 'x' ? "taken" : "";
          } catch (const std::bad_alloc&) {
            return "refused";
          }
        },
        60.0);
  };
  EXPECT_EQ(take(32).result, "taken");
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they end where memory does
  EXPECT_EQ(take(1024).result, "refused");
#endif
}

TEST(IsolatedCall, ProcessorTimeIsLimited) {
  const IsolatedEnd end = RunIsolated(
      [](const Announce&) -> std::string {
        LimitProcess(size_t{256} << 20, 1);
        for (volatile unsigned i = 0;;) static_cast<void>(i);
      },
      60.0);
  EXPECT_EQ(end.kind, Kind::kSignal);
  EXPECT_TRUE(end.code == SIGXCPU || end.code == SIGKILL) << end.code;
}

TEST(IsolatedCall, NoFileIsOpenedOrWrittenWhereThatIsForbidden) {
  const auto open_file = [](bool is_forbidden) {
    return RunIsolated(
        [=](const Announce&) -> std::string {
          if (is_forbidden) ForbidOpeningFiles();
          return open("/dev/null", O_RDONLY) < 0 ? "refused" : "opened";
        },
        60.0);
  };
  EXPECT_EQ(open_file(false).result, "opened");
  EXPECT_EQ(open_file(true).result, "refused");
}

}  // namespace
}  // namespace rcme
