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

// Adds `process` and `answers`: estimators outside the program, in any language. Likewise.
void AddOutsideEstimators();

// What the option `digest` of `answers` takes for a file. Throws InputError for one that holds no answers.
std::string DigestOfAnswers(const std::string& path);

}  // namespace rcme
