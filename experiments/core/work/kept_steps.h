// Work of steps, one after the other, where what a step is depends on what those before it gave. The runner
// keeps what each step gives by its number: the same command takes the same steps.
#pragma once

#include <functional>
#include <string>

#include "experiments/core/work/runner.h"

namespace rcme {

// How what a step gives is kept: the text of a JSON value on one line, to the last bit of what is used of it.
// `read` throws std::exception for what no step gives.
template <typename T>
struct StepForm {
  std::function<std::string(const T&)> write;
  std::function<T(const std::string&)> read;
};

class KeptSteps {
 public:
  // The runner's plan is open; it outlives this. Says how many steps are there already.
  explicit KeptSteps(Runner* runner);

  // What the next step gives, computed or kept. Throws Stopped and KeptResultsError.
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

// Throws Stopped if a request has come.
void StopBeforeStep();

// The next of the steps; without `steps` it is computed and kept nowhere.
template <typename T>
T TakeStep(KeptSteps* steps, const std::function<T()>& compute, const StepForm<T>& form) {
  if (steps != nullptr) return steps->Next(compute, form);
  StopBeforeStep();
  return compute();
}

}  // namespace rcme
