#pragma once

#include <string>

namespace rcme {

// Adds the estimators of other libraries to the registry (estimator_registry.h), each with its library's
// version in its description. Call it once, from one thread, before anything reads the registry. Stops OpenCV
// from starting threads of its own.
//
// Answers are pure functions of problem and stream for a given build of the library. Another version, or a
// machine with other vector instructions, may give different ones.
void AddPeers();

// Adds `process` and `answers`, estimators outside the program in any language, and `conform`, which wraps
// any other estimator. The same rules hold.
void AddOutsideEstimators();

// Starts the command of an estimator `process` and asks it a small problem. Throws InputError if the process
// ends or closes its output before any answer: the command is not found, or a library is missing. Any answer
// is accepted, and so is no answer within 10 s.
void RequireCommandAnswers(const std::string& command, double timeout_s);

// The value of the option `digest` of `answers` for a file. Throws InputError if the file contains no
// answers.
std::string DigestOfAnswers(const std::string& path);

}  // namespace rcme
