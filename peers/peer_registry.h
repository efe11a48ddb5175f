#pragma once

#include <string>

namespace rcme {

// Adds the estimators of other libraries to the table (estimator_registry.h), each with its library's version
// in its sentence. To be called once, before anything reads the table, from one thread. OpenCV is set to
// start no threads of its own.
//
// Their answers are pure functions of problem and stream as everybody's, but of the library too: another
// version, or a machine with other vector instructions, may give other bytes.
void AddPeers();

// Adds `process` and `answers`, estimators outside the program in any language, and `conform`, which wraps
// any other. Likewise.
void AddOutsideEstimators();

// Starts the command of an estimator `process` and asks it a small problem. Throws InputError if the process
// ends, or closes its output, before it has answered anything: a command that is not found, a library that is
// missing. Any answer will do, and none within 10 s too.
void RequireCommandAnswers(const std::string& command, double timeout_s);

// What the option `digest` of `answers` takes for a file. Throws InputError for one that holds no answers.
std::string DigestOfAnswers(const std::string& path);

}  // namespace rcme
