#include "experiments/commands/common_options.h"

#include "experiments/commands/number_option.h"

namespace rcme {

CLI::Option* AddStudyArgument(CLI::App* command, std::string* study) {
  return command
      ->add_option("study", *study,
                   "study file (YAML), or the name of an installed one (`rcme list studies`)")
      ->required();
}

CLI::Option* AddThreadsOption(CLI::App* command, int* threads, const std::string& what) {
  return command->add_option("--threads", *threads, "threads; 0: one per core. " + what)
      ->transform(WholeNumberIn(0, 1024));
}

CLI::Option* AddSeedOption(CLI::App* command, std::int64_t* seed, const std::string& of) {
  return command->add_option("--seed", *seed, "seed of " + of)
      ->transform(WholeNumberIn(0))
      ->capture_default_str();
}

CLI::Option* AddEstimatorsOption(CLI::App* command, std::vector<std::string>* labels,
                                 const std::string& what) {
  return command->add_option("--estimators,--estimator", *labels, what)
      ->delimiter(',')
      ->allow_extra_args(false);
}

CLI::Option* AddSigmaOption(CLI::App* command, std::optional<double>* sigma_px) {
  return command
      ->add_option(
          "--sigma", *sigma_px,
          "standard deviation of the noise per coordinate that the estimator assumes, px; default: the "
          "header '# sigma_px' of a match file, otherwise 0.5")
      ->transform(NumberIn({1e-9, 1000.0}));
}

}  // namespace rcme
