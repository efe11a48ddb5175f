// All harnesses in one program, without libFuzzer: one of them reads every input of a folder, then damaged
// copies of them for some seconds.
//
//   replay_inputs NAME SECONDS FOLDER
//
// Copy number n is a pure function of n and the folder. What an input cannot be read without (a crash, an
// exception that is no InputError, more than kMaxSecondsPerInput) leaves that input in the file
// NAME_fuzzer.crash of the working folder, and ends with the signal.
#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "stats/random.h"
#include "tests/fuzz/harness/harnesses.h"
#include "tests/test_support/mutated.h"

namespace rcme {
namespace {

constexpr unsigned kMaxSecondsPerInput = 120;  // a reader in a process of its own has 60

std::string* crash_file;   // where the input below goes
const std::string* input;  // the one that is read
const pid_t process = getpid();

void KeepInput(int signal) {
  const bool is_child = getpid() != process;  // of a reader that expects its child to crash
  const int file = is_child ? -1 : open(crash_file->c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (file >= 0 && write(file, input->data(), input->size()) >= 0) {
    constexpr char kWords[] = "an input could not be read; it is kept in the file NAME_fuzzer.crash here\n";
    if (write(STDERR_FILENO, kWords, sizeof(kWords) - 1) < 0) _exit(1);
  }
  std::signal(signal, SIG_DFL);
  raise(signal);
}

void Read(const std::string& bytes, Harness harness) {
  input = &bytes;
  alarm(kMaxSecondsPerInput);
  harness(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

std::vector<std::string> ReadInputs(const std::string& folder) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> inputs;
  for (const std::filesystem::path& path : paths) {
    std::ifstream file(path, std::ios::binary);
    inputs.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return inputs;
}

// Put into the copies, beside changes of their bytes.
const std::vector<std::string>& Words() {
  static const std::vector<std::string> words = {"[",
                                                 "]",
                                                 "{",
                                                 "}",
                                                 "\"",
                                                 ":",
                                                 ",",
                                                 "\n",
                                                 " ",
                                                 "#",
                                                 "null",
                                                 "nan",
                                                 "-inf",
                                                 "1e999",
                                                 "-1",
                                                 "0",
                                                 "1e-320",
                                                 "[[[[[[[[",
                                                 "\\u0000",
                                                 "\xFF",
                                                 "\xEF\xBB\xBF",
                                                 "....",
                                                 "99999999999999999999",
                                                 std::string(8, '\0'),
                                                 std::string(8, '\xFF')};
  return words;
}

void ReadForSeconds(Harness harness, double seconds, const std::string& folder) {
  const std::vector<std::string> inputs = ReadInputs(folder);
  for (const std::string& bytes : inputs) Read(bytes, harness);
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  std::uint32_t number = 0;
  for (; !inputs.empty() && std::chrono::steady_clock::now() < end; ++number) {
    RandomStream rng({.seed = 1, .trial = number, .purpose = 78});
    Read(Mutated(inputs[number % inputs.size()], Words(), rng), harness);
  }
  alarm(0);
  std::printf("%zu inputs and %u damaged copies\n", inputs.size(), number);
  if (inputs.empty()) std::exit(2);
}

}  // namespace
}  // namespace rcme

int main(int argc, char** argv) {
  if (argc != 4 || !rcme::Harnesses().contains(argv[1])) {
    std::fprintf(stderr, "usage: %s NAME SECONDS FOLDER, where NAME is one of:", argv[0]);
    for (const auto& [name, harness] : rcme::Harnesses()) std::fprintf(stderr, " %s", name.c_str());
    std::fprintf(stderr, "\n");
    return 2;
  }
  std::string crash_file = std::string(argv[1]) + "_fuzzer.crash";
  rcme::crash_file = &crash_file;
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGALRM})
    std::signal(signal, rcme::KeepInput);
  rcme::ReadForSeconds(rcme::Harnesses().at(argv[1]), std::atof(argv[2]), argv[3]);
}
