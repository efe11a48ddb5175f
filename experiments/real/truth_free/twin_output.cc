#include "experiments/real/truth_free/twin_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "experiments/core/table/render_table.h"
#include "experiments/core/text/json_output.h"
#include "experiments/real/truth_free/twin_quantities.h"

namespace rcme {
namespace {

std::string DescribeTails(const RedrawSettings& noise) {
  return noise.student_dof == 0.0 ? "normal" : fmt::format("Student's t of {:g}", noise.student_dof);
}

std::string DescribeNoise(const RedrawSettings& noise) {
  std::string text = fmt::format("{:.3g} px, {}", noise.noise_px, DescribeTails(noise));
  if (noise.near_share >= 0.005)
    text += fmt::format(", {:.0f} % common within 1 px", 100.0 * noise.near_share);
  if (noise.far_share >= 0.005)
    text += fmt::format(", {:.0f} % within {:g} px", 100.0 * noise.far_share, noise.far_length_px);
  return text;
}

std::string DescribeFit(const TwinReport& report) {
  const TwinFit& fit = report.fit;
  std::string text = FormatParagraph(fmt::format("{}: {} pairs, {} with a geometry to resemble", report.scene,
                                                 report.num_pairs, fit.num_templates)) +
                     FormatParagraph("  noise " + DescribeNoise(fit.noise));
  if (!report.simulated.empty()) {
    text += FormatParagraph(fmt::format("  simulated with {:.3g} px and {}", fit.simulated_noise.noise_px,
                                        DescribeTails(fit.simulated_noise)));
  }
  return text +
         FormatParagraph(fmt::format("  {} matches, {:.0f} % wrong ({:.0f} % of those move as a neighbour)",
                                     fit.num_matches, 100.0 * fit.wrong_share,
                                     100.0 * fit.wrong_agreeing_share)) +
         FormatParagraph(fmt::format(
             "  rotation {:.2g} deg, parallax {:.2g} deg, |t_z| {:.2f}, depths {:.2g} to {:.2g} baselines, "
             "one plane explains {:.0f} %, Clark-Evans {:.2f}",
             fit.rotation_deg, fit.parallax_deg, fit.forwardness, fit.nearest, fit.farthest,
             100.0 * fit.homography_share, fit.clark_evans));
}

nlohmann::ordered_json RenderSettings(const Settings& settings) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const auto& [key, value] : settings) json[key] = value;
  return json;
}

// "3 of 4 predicted, 4 of 4 fitted".
std::string WithinText(const TwinReport& report, const std::string& twin) {
  return fmt::format("{} of {} predicted, {} of {} fitted", report.NumWithin(twin, false),
                     report.NumCompared(twin, false), report.NumWithin(twin, true),
                     report.NumCompared(twin, true));
}

// The comparisons with one twin.
Table MakeComparisonTable(const TwinReport& report, const std::string& twin, const std::string& heading) {
  Table table{{Column::Key("quantity"), Column::Count("n"), Column::Number(heading),
               Column::Estimated("observed [joint 95 %]", kSignificant), Column::Flag("fitted"),
               Column::Flag("within")}};
  for (const TwinComparison& c : report.comparisons) {
    if (c.twin == twin)
      table.rows.push_back(
          {c.quantity, c.n, c.predicted, Estimate{c.observed, c.joint}, c.is_fitted, c.IsWithin()});
  }
  return table;
}

// What the semi-real twin misses, and what may be missing in it.
std::string DescribeMissed(const TwinReport& report) {
  std::string text;
  for (const TwinComparison& c : report.comparisons) {
    if (c.IsWithin() || c.twin != "semi_real") continue;
    const auto& of = *std::ranges::find(kQuantityTexts, c.quantity, &QuantityText::name);
    text += FormatParagraph(
        fmt::format("  not {}: {}: {}", c.is_fitted ? "met by the fit" : "explained", of.words, of.missing));
  }
  return text;
}

std::string ReportAsText(const TwinReport& report) {
  std::string text =
      DescribeFit(report) + "\n" + RenderText(MakeComparisonTable(report, "semi_real", "semi-real")) + "\n";
  std::string within = "  within: semi-real " + WithinText(report, "semi_real");
  if (report.simulated.empty()) {
    within += "; no simulated scene: " + report.why_not_simulated;
  } else {
    text += RenderText(MakeComparisonTable(report, "simulated", "simulated")) + "\n";
    within += "; simulated " + WithinText(report, "simulated");
  }
  return text + FormatParagraph(within) + DescribeMissed(report) + "\n";
}

// A row of the files.
struct TwinRow {
  const TwinReport* report;
  const TwinComparison* comparison;
};

Table MakeRowTable(const std::vector<TwinReport>& reports) {
  using R = const TwinRow&;
  std::vector<TwinRow> rows;
  for (const TwinReport& report : reports) {
    for (const TwinComparison& comparison : report.comparisons) rows.push_back({&report, &comparison});
  }
  return MakeTable<TwinRow>(
      {{{.name = "scene", .json_name = kNotInJson}, [](R r) { return r.report->scene; }},
       {{.name = "pairs", .type = ColumnType::kCount, .json_name = kNotInJson},
        [](R r) { return r.report->num_pairs; }},
       {{"twin"}, [](R r) { return r.comparison->twin; }},
       {{"quantity"}, [](R r) { return r.comparison->quantity; }},
       {{"kind"}, [](R r) { return std::string(r.comparison->is_rate ? "rate" : "mean"); }},
       {Column::Flag("fitted"), [](R r) { return r.comparison->is_fitted; }},
       {{"observed", ColumnType::kNumber}, [](R r) { return r.comparison->observed; }},
       {{"lower,upper", ColumnType::kInterval}, [](R r) { return r.comparison->joint; }},
       {{"n", ColumnType::kCount}, [](R r) { return r.comparison->n; }},
       {{"predicted", ColumnType::kNumber}, [](R r) { return r.comparison->predicted; }},
       {Column::Flag("within"), [](R r) { return r.comparison->IsWithin(); }}},
      rows);
}

std::string TwinsAsText(const std::vector<TwinReport>& reports) {
  std::string text;
  for (const TwinReport& report : reports) text += ReportAsText(report);
  text += FormatParagraph(
      "semi-real: the key points of the pairs, put where the estimated geometry has them, with noise drawn "
      "anew and wrong matches dealt out again; simulated: a scene of the simulator fitted to the numbers "
      "above. n: pairs compared. Observed intervals hold for all quantities of a scene together and respect "
      "images that pairs share; without one it is unbounded. fitted: the twins were made to agree in it, "
      "which is no evidence. Shares and rates are from 0 to 1.");
  Table quantities{{Column::Key("quantity"), Column::Text("what it is")}};
  for (const QuantityText& quantity : kQuantityTexts)
    quantities.rows.push_back({quantity.name, quantity.words});
  return text + "\n" + RenderText(quantities);
}

std::string TwinsAsJson(const std::vector<TwinReport>& reports) {
  nlohmann::ordered_json json = {{"scenes", nlohmann::ordered_json::array()}};
  for (const TwinReport& report : reports) {
    json["scenes"].push_back({{"name", report.scene},
                              {"pairs", report.num_pairs},
                              {"templates", report.fit.num_templates},
                              {"semi_real", RenderSettings(report.semi_real)},
                              {"simulated", RenderSettings(report.simulated)},
                              {"why_not_simulated", report.why_not_simulated},
                              {"comparisons", RenderJson(MakeRowTable({report}))}});
  }
  return JsonText(kTwinFormat, json);
}

}  // namespace

CommandResult MakeTwinsResult(const std::vector<TwinReport>& reports) {
  return {TwinsAsText(reports), MakeRowTable(reports), TwinsAsJson(reports)};
}

}  // namespace rcme
