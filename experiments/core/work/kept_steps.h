// Sequential work in which each step depends on the results of those before it. The runner keeps the result
// of each step by its number, which identifies it because the same command takes the same steps.
#pragma once

#include <functional>
#include <string>

#include "experiments/core/work/runner.h"

namespace rcme {

// Converts a step's result to and from the text of a JSON value on one line. No bit of the values used may be
// lost. `read` throws std::exception for a text that no step can have given.
template <typename T>
struct StepForm {
  std::function<std::string(const T&)> write;
  std::function<T(const std::string&)> read;
};

class KeptSteps {
 public:
  // The runner's plan must be open; the runner must outlive this object. Prints the number of steps kept
  // already.
  explicit KeptSteps(Runner* runner);

  // Returns the result of the next step, kept or newly computed. Throws Stopped and KeptResultsError.
  template <typename T>
  T Next(const std::function<T()>& compute, const StepForm<T>& form) {
    const ItemPlace place = {0, num_taken_++};
    runner_->GetOne(place, [&](const ItemPlace&) { return form.write(compute()); });
    T result;
    ReadResult(runner_->plan(), runner_->results(), place,
               [&](const ItemPlace&, const std::string& json) { result = form.read(json); });
    return result;
  }

 private:
  Runner* runner_;
  size_t num_taken_ = 0;
};

// Throws Stopped if a stop was requested.
void StopBeforeStep();

// Takes the next step. `steps` may be null: the step is then computed and not kept.
template <typename T>
T TakeStep(KeptSteps* steps, const std::function<T()>& compute, const StepForm<T>& form) {
  if (steps != nullptr) return steps->Next(compute, form);
  StopBeforeStep();
  return compute();
}

}  // namespace rcme
