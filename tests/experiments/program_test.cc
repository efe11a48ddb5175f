// What the program does at its very end: an exception that nobody can catch.
#include "experiments/program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <thread>

namespace rcme {
namespace {

using testing::ExitedWithCode;
using testing::HasSubstr;
using testing::KilledBySignal;
using testing::Not;

constexpr const char* kNoMemory = "rcme: there is not enough memory; give it more, or a smaller input";

// Sets up what every command has. An abort leaves no core file.
void RunProgramOnce() {
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  const char* const arguments[] = {"rcme", "--version"};
  if (RunProgram(2, arguments) != 0) std::_Exit(1);
}

// Throws std::bad_alloc when not even a byte is left; with a sanitizer, which needs memory itself, at once.
void UseAllMemory() {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  const rlimit no_more{1, 1};
  setrlimit(RLIMIT_AS, &no_more);
  for (size_t size = 1 << 20; size > 0; size /= 2) {
    char* volatile last = nullptr;
    do {
      last = new (std::nothrow) char[size];
    } while (last);
  }
#endif
  throw std::bad_alloc();
}

void RunThreadThat(void (*work)()) {
  RunProgramOnce();
  std::thread(work).join();
}

class Thrower {
 public:
  explicit Thrower(void (*work)()) : work_(work) {}
  ~Thrower() { work_(); }

 private:
  void (*work_)();
};

void RunDestructorThat(void (*work)()) {
  RunProgramOnce();
  const Thrower thrower(work);
}

class ProgramDeathTest : public testing::Test {
 protected:
  void SetUp() override { testing::FLAGS_gtest_death_test_style = "threadsafe"; }
};

// In a thread of a library's and in a destructor: no abort, and a message that needs no memory itself.
TEST_F(ProgramDeathTest, WithoutMemoryEndsWithTwoAndAMessage) {
  EXPECT_EXIT(RunThreadThat(UseAllMemory), ExitedWithCode(2), HasSubstr(kNoMemory));
  EXPECT_EXIT(RunDestructorThat(UseAllMemory), ExitedWithCode(2), HasSubstr(kNoMemory));
}

// Another exception is a fault of the program, which must not be taken for a lack of memory.
TEST_F(ProgramDeathTest, ByAnotherExceptionIsAnAbort) {
  EXPECT_EXIT(RunThreadThat([] { throw std::runtime_error("a fault"); }), KilledBySignal(SIGABRT),
              Not(HasSubstr("memory")));
}

}  // namespace
}  // namespace rcme
