#include "experiments/real/truth_free/twin_output.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "experiments/core/table/render_table.h"
#include "experiments/core/text/columns.h"
#include "experiments/core/text/json_output.h"
#include "experiments/real/truth_free/twin_quantities.h"

namespace rcme {
namespace {

std::string NumberText(const TwinComparison& c, double x) {
  return c.is_rate ? fmt::format("{:.1f} %", 100.0 * x) : fmt::format("{:.3g}", x);
}

std::string TailsInWords(const RedrawSettings& noise) {
  return noise.student_dof == 0.0 ? "normal" : fmt::format("Student's t of {:g}", noise.student_dof);
}

std::string NoiseInWords(const RedrawSettings& noise) {
  std::string text = fmt::format("{:.3g} px, {}", noise.noise_px, TailsInWords(noise));
  if (noise.near_share >= 0.005)
    text += fmt::format(", {:.0f} % common within 1 px", 100.0 * noise.near_share);
  if (noise.far_share >= 0.005)
    text += fmt::format(", {:.0f} % within {:g} px", 100.0 * noise.far_share, noise.far_length_px);
  return text;
}

std::string FitInWords(const TwinReport& report) {
  const TwinFit& fit = report.fit;
  std::string text = fmt::format("{}: {} pairs, {} with a geometry to resemble\n  noise {}", report.scene,
                                 report.num_pairs, fit.num_templates, NoiseInWords(fit.noise));
  if (!report.simulated.empty()) {
    text += fmt::format("\n  simulated with {:.3g} px and {}", fit.simulated_noise.noise_px,
                        TailsInWords(fit.simulated_noise));
  }
  return text +
         fmt::format(
             "\n  {} matches, {:.0f} % wrong ({:.0f} % of those move as a neighbour)\n"
             "  rotation {:.2g} deg, parallax {:.2g} deg, |t_z| {:.2f}, depths {:.2g} to {:.2g} baselines, "
             "one plane explains {:.0f} %, Clark-Evans {:.2f}\n",
             fit.num_matches, 100.0 * fit.wrong_share, 100.0 * fit.wrong_agreeing_share, fit.rotation_deg,
             fit.parallax_deg, fit.forwardness, fit.nearest, fit.farthest, 100.0 * fit.homography_share,
             fit.clark_evans);
}

const TwinComparison* Find(const TwinReport& report, const std::string& quantity, const std::string& twin) {
  for (const TwinComparison& c : report.comparisons) {
    if (c.quantity == quantity && c.twin == twin) return &c;
  }
  return nullptr;
}

nlohmann::ordered_json JsonOf(const Settings& settings) {
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

std::string ReportAsText(const TwinReport& report) {
  std::vector<std::vector<std::string>> rows = {
      {"quantity", "n", "semi-real", "observed [joint 95 %]", "", "simulated", "observed [joint 95 %]", ""}};
  std::string missed;
  for (const QuantityText& text : kQuantityTexts) {
    std::vector<std::string> row = {text.name, ""};
    for (const char* twin : {"semi_real", "simulated"}) {
      const TwinComparison* c = Find(report, text.name, twin);
      if (c == nullptr) {
        row.insert(row.end(), {"-", "-", ""});
        continue;
      }
      const std::string n = fmt::format("{}", c->n);
      if (row[1] != n) row[1] += row[1].empty() ? n : "/" + n;
      const std::string kind = c->is_fitted ? "fitted" : "predicted";
      row.insert(row.end(), {NumberText(*c, c->predicted),
                             fmt::format("{} [{}, {}]", NumberText(*c, c->observed),
                                         NumberText(*c, c->joint.lower), NumberText(*c, c->joint.upper)),
                             kind + (c->IsWithin() ? "" : ", NOT WITHIN")});
      if (!c->IsWithin() && c->twin == "semi_real") {
        missed += fmt::format("  not {}: {}: {}\n", c->is_fitted ? "met by the fit" : "explained", text.words,
                              text.missing);
      }
    }
    if (row[1].empty()) continue;
    rows.push_back(row);
  }
  std::string text = FitInWords(report) + FormatColumns(rows);
  text += "  within: semi-real " + WithinText(report, "semi_real");
  text += report.simulated.empty() ? fmt::format("; no simulated scene: {}\n", report.why_not_simulated)
                                   : "; simulated " + WithinText(report, "simulated") + "\n";
  return text + missed + "\n";
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
       {{"fitted", ColumnType::kFlag}, [](R r) { return r.comparison->is_fitted; }},
       {{"observed", ColumnType::kNumber}, [](R r) { return r.comparison->observed; }},
       {{"lower,upper", ColumnType::kInterval}, [](R r) { return r.comparison->joint; }},
       {{"n", ColumnType::kCount}, [](R r) { return r.comparison->n; }},
       {{"predicted", ColumnType::kNumber}, [](R r) { return r.comparison->predicted; }},
       {{"within", ColumnType::kFlag}, [](R r) { return r.comparison->IsWithin(); }}},
      rows);
}

}  // namespace

std::string TwinsAsText(const std::vector<TwinReport>& reports) {
  std::string text;
  for (const TwinReport& report : reports) text += ReportAsText(report);
  text +=
      "semi-real: the key points of the pairs, put where the estimated geometry has them, with noise drawn "
      "anew and "
      "wrong\nmatches dealt out again; simulated: a scene of the simulator fitted to the numbers above. "
      "n: pairs compared (semi-real/simulated where they differ). Observed "
      "intervals hold for all\nquantities of a scene together and respect images that pairs share. "
      "fitted: the twins were made to agree in it, which is\nno evidence; predicted: they were not. "
      "Quantities:\n";
  for (const QuantityText& quantity : kQuantityTexts)
    text += fmt::format("  {:<18}{}\n", quantity.name, quantity.words);
  return text;
}

std::string TwinsAsCsv(const std::vector<TwinReport>& reports) { return RenderCsv(MakeRowTable(reports)); }

std::string TwinsAsJson(const std::vector<TwinReport>& reports) {
  nlohmann::ordered_json json = {{"scenes", nlohmann::ordered_json::array()}};
  for (const TwinReport& report : reports) {
    json["scenes"].push_back({{"name", report.scene},
                              {"pairs", report.num_pairs},
                              {"templates", report.fit.num_templates},
                              {"semi_real", JsonOf(report.semi_real)},
                              {"simulated", JsonOf(report.simulated)},
                              {"why_not_simulated", report.why_not_simulated},
                              {"comparisons", RenderJson(MakeRowTable({report}))}});
  }
  return JsonText(kTwinFormat, json);
}

}  // namespace rcme
