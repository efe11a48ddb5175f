#include <algorithm>

#include "parameters/input_error.h"
#include "simulator/outlier_registry.h"
#include "simulator/outliers/outlier_laws.h"
#include "simulator/split_by_shares.h"

namespace rcme {
namespace {

// All other laws of the registry, each with a weight. The wrong matches are split by the weights to within
// one match; which match follows which law is random. A key shared by several laws sets all of them.
class OutlierMixture : public OutlierLaw {
 public:
  OutlierMixture() {
    for (const OutlierEntry& entry : OutlierRegistry()) {
      if (entry.name == "mixture") continue;
      const bool is_default =
          entry.name == "uniform" || entry.name == "displaced";  // far and near mismatches
      parts_.push_back({entry.name, entry.make(), is_default ? 1.0 : 0.0});
    }
  }

  std::vector<Parameter> Parameters() override {
    std::vector<Parameter> all;
    for (Part& part : parts_) {
      all.push_back(Parameter::Real("weight_" + part.name, &part.weight, {0.0, 1e6}, "",
                                    "share of these wrong matches, over the sum of weights"));
    }
    std::vector<std::vector<Parameter>> by_name;
    for (Part& part : parts_) {
      for (const Parameter& parameter : part.law->Parameters()) {
        const auto same = std::ranges::find(
            by_name, parameter.name(), [](const std::vector<Parameter>& group) { return group[0].name(); });
        if (same == by_name.end())
          by_name.push_back({parameter});
        else
          same->push_back(parameter);
      }
    }
    for (const std::vector<Parameter>& same : by_name) all.push_back(Parameter::Together(same));
    return all;
  }

  void Replace(std::span<const std::uint32_t> points, const MatchedScene& matched,
               RandomStream& rng) const override {
    if (points.empty()) return;
    std::vector<double> weights;
    for (const Part& part : parts_) weights.push_back(part.weight);
    if (std::ranges::all_of(weights, [](double weight) { return weight == 0.0; })) ThrowNoWeight();
    const std::vector<int> counts = SplitByShares(static_cast<int>(points.size()), weights);
    for (size_t i = 0; i < parts_.size(); ++i) {
      const auto count = static_cast<size_t>(counts[i]);
      parts_[i].law->Replace(points.first(count), matched, rng);
      points = points.subspan(count);
    }
  }

 private:
  struct Part {
    std::string name;
    std::unique_ptr<OutlierLaw> law;
    double weight;
  };

  [[noreturn]] void ThrowNoWeight() const {
    std::string keys;
    for (const Part& part : parts_) keys += (keys.empty() ? "weight_" : ", weight_") + part.name;
    throw InputError("outliers: 'mixture' is not allowed with all weights zero; give at least one of: " +
                     keys);
  }

  std::vector<Part> parts_;
};

}  // namespace

std::unique_ptr<OutlierLaw> MakeOutlierMixture() { return std::make_unique<OutlierMixture>(); }

}  // namespace rcme
