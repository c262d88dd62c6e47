// SPDX-License-Identifier: Apache-2.0
#include "study/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/json.h"
#include "image/tonemap.h"
#include "probe/convert.h"
#include "probe/mapping.h"
#include "study/report/log_log_plot.h"
#include "study/result_tables.h"

namespace chromeball {

// The contents of report.html and report.js in this folder; CMake puts them into a source file.
extern const char* const kReportHtml;
extern const char* const kReportScript;

namespace {

// Replaces {{name}} by its contents.
void fill(std::string& page, const std::string& name, const std::string& contents) {
  const std::string mark = "{{" + name + "}}";
  for (size_t at = page.find(mark); at != std::string::npos;
       at = page.find(mark, at + contents.size()))
    page.replace(at, mark.size(), contents);
}

std::string plot(const StudyResults& results, const char* title, const char* xLabel, Ticks ticks,
                 double (*abscissa)(const Cell&)) {
  PlotPanel panel{"", {}};
  for (const StrategyResult& strategy : results.strategies) {
    PlotSeries& series = panel.series.emplace_back(PlotSeries{strategy.name, {}});
    for (const Cell& cell : strategy.cells) {
      const Estimate& e = cell.error.relMse;
      series.points.push_back({abscissa(cell), e.mean, e.low(), e.high()});
    }
  }
  return logLogPlot(title, xLabel, "relMSE", {panel}, ticks);
}

std::string dots(const std::string& name, const std::vector<vec3>& directions) {
  std::string svg = "<svg viewBox=\"0 0 200 100\">";
  for (const vec3& direction : directions) {
    const auto uv = directionToUv(Mapping::LatLong, glm::dvec3(direction));
    svg += fmt::format(
        "<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"1.1\" fill=\"#fff\" stroke=\"#000\" "
        "stroke-width=\".5\"/>",
        200 * uv.x, 100 * uv.y);
  }
  return fmt::format(
      "<figure>{}</svg><figcaption><b>{}</b>{}</figcaption></figure>\n", svg, escaped(name),
      directions.empty() ? ": no light samples; its BSDF samples hit the probe" : "");
}

std::string probeUri(const Probe& probe) {
  const Image preview = probePreview(probe, 512);
  std::vector<uint8_t> bytes;
  for (const float number : preview.texels)
    bytes.push_back(uint8_t(std::lround(255 * linearToSrgb(number))));
  return pngUri(preview.width, preview.height, 3, bytes);
}

std::string paragraphs(const std::vector<std::string>& texts) {
  std::string html;
  for (const std::string& text : texts) html += "<p class=\"warning\">" + escaped(text) + "</p>\n";
  return html;
}

std::string verdictList(const Study& study, const StudyResults& results) {
  const std::vector<std::string> sentences = verdict(study, results);
  if (sentences.empty()) return "";
  std::string html = "<ul id=\"verdict\">\n";
  for (const std::string& sentence : sentences) html += "<li>" + escaped(sentence) + "</li>\n";
  return html + "</ul>\n";
}

std::string repeatsText(const StudyResults& results) {
  size_t minimum = SIZE_MAX, maximum = 0;
  for (const StrategyResult& strategy : results.strategies)
    for (const Cell& cell : strategy.cells) {
      minimum = std::min(minimum, cell.repeatSeconds.size());
      maximum = std::max(maximum, cell.repeatSeconds.size());
    }
  return minimum < maximum ? fmt::format("{} to {}", minimum, maximum) : fmt::format("{}", maximum);
}

std::string referenceText(const Study& study, const StudyResults& results) {
  const std::string origin = study.referenceFile.empty()
                                 ? fmt::format("{} samples per pixel with {}",
                                               study.referenceSamples, study.referenceStrategy)
                                 : study.referenceFile;
  return fmt::format("{}, relative standard error {:.2g}% per pixel", origin,
                     100 * results.referenceNoise);
}

// What follows the number is soft.
std::string softened(const std::string& text) {
  const size_t space = text.starts_with("not significant") ? 0 : text.find(' ');
  if (space == std::string::npos) return text;
  std::string soft = text.substr(space);
  if (const size_t sign = soft.find("+-"); sign != std::string::npos)
    soft.replace(sign, 2, "&plusmn;");
  return fmt::format("{}<span class=\"soft\">{}</span>", text.substr(0, space), soft);
}

std::string plusMinus(const Estimate& e) {
  const EstimateText text = estimateText(e);
  return softened(text.halfInterval == "0"
                      ? text.number
                      : fmt::format("{} +- {}", text.number, text.halfInterval));
}

std::string row(const Cell& cell, const StrategyResult& strategy, double mostEfficient) {
  const double width = 70 * std::max(0.0, cell.efficiency.value / mostEfficient);
  std::string crossing = "none detected";
  if (strategy.unbiased) crossing = "unbiased";
  if (const auto& c = strategy.biasEqualsNoise)
    crossing = fmt::format("{} <span class=\"soft\">({} to {})</span>", shortNumber(c->samples, 2),
                           shortNumber(c->low, 2), shortNumber(c->high, 2));
  return fmt::format(
      "<tr data-strategy=\"{0}\"><td>{0}</td><td class=\"bars\"><span class=\"bar\" "
      "style=\"width:{1:.0f}px\"></span></td><td>{2}</td><td>{3}</td><td>{4}</td><td>{5:.3f}</"
      "td><td>{6}</td><td>{7}</td><td>{8}</td><td>{9}</td><td>{10}</td></tr>\n",
      escaped(cell.strategy), width, softened(ratioText(cell.efficiency)),
      softened(positiveText(cell.error.relMse)), softened(positiveText(cell.seconds)),
      cell.prepareSeconds, softened(biasText(cell.error.bias, cell.light)),
      strategy.variance ? plusMinus(strategy.variance->slope) : "",
      strategy.relMse ? plusMinus(strategy.relMse->slope) : "",
      strategy.unbiased ? "" : softened(significantText(strategy.squaredBias)), crossing);
}

// What the table says of rows that have missed light; empty if there are none.
std::string missedNote(const Study& study, const StudyResults& results) {
  for (const Cell* cell : ranking(study, results))
    if (cell->light == FoundLight::Missed)
      return " Light not found: an unbiased strategy, whose mean is no bias of the method but "
             "lacks rare bright light that its few samples have not met; its error is larger than "
             "here, its efficiency unknown.";
  return "";
}

// The strategies with the largest common budget, the most efficient first.
std::string resultsHtml(const Study& study, const StudyResults& results) {
  std::string html =
      "<table "
      "id=\"results\"><thead><tr><th>strategy</th><th></th><th>efficiency</th><th>relMSE</"
      "th><th>seconds</th><th>preparation,<br>seconds</th><th>bias, %</th><th>slope "
      "of<br>variance</th><th>slope of<br>relMSE</th><th>relMSE<br>of bias</th><th>bias = "
      "noise<br>at samples</th></tr></thead><tbody>\n";
  const std::vector<const Cell*> cells = ranking(study, results);
  for (const Cell* cell : cells)
    for (const StrategyResult& strategy : results.strategies)
      if (strategy.name == cell->strategy)
        html += row(*cell, strategy, cells.front()->efficiency.value);
  return html + "</tbody></table>\n";
}

// The pairs of unbiased strategies that were tested for agreement.
std::string pairsHtml(const StudyResults& results) {
  if (results.pairs.empty()) return "<p>Fewer than two strategies can be compared here.</p>\n";
  std::string html =
      "<table id=\"pairs\"><thead><tr><th>pair</th><th>p</th><th>tiles that "
      "differ</th></tr></thead><tbody>\n";
  for (const PairResult& pair : results.pairs)
    html += fmt::format("<tr><td>{} and {}</td><td{}>{:.2g}</td><td>{:.2g}%</td></tr>\n",
                        escaped(pair.a), escaped(pair.b),
                        pair.agreement.pValue < 0.05 ? " class=\"fails\"" : "",
                        pair.agreement.pValue, 100 * pair.agreement.fraction);
  return html + "</tbody></table>\n";
}

}  // namespace

std::string samplesPlot(const StudyResults& results) {
  return plot(results, "error against samples", "samples per pixel", Ticks::Binary,
              [](const Cell& cell) { return cell.samples; });
}

std::string secondsPlot(const StudyResults& results) {
  return plot(results, "error against time", "seconds", Ticks::Decimal,
              [](const Cell& cell) { return cell.seconds.mean; });
}

std::string reportHtml(const Study& study, const RenderStore& store, const StudyResults& results,
                       const ReportScene& scene, const Machine& machine) {
  const std::optional<Budget> budget = largestCommonBudget(study, results);
  const std::string at = budget ? budget->label() : "no common budget";
  std::string page = kReportHtml;
  fill(page, "title",
       escaped(fmt::format("{}: {} lighting strategies", scene.name, results.strategies.size())));
  fill(page, "subtitle",
       escaped(fmt::format(
           "{} x {} pixels, {} independent renders of each strategy and budget; reference: {}.",
           results.reference.mean.width, results.reference.mean.height, repeatsText(results),
           referenceText(study, results))));
  fill(page, "verdict", verdictList(study, results));
  fill(page, "warnings", paragraphs(results.warnings));
  fill(page, "plots", samplesPlot(results) + secondsPlot(results));
  fill(page, "tableNote",
       escaped(
           fmt::format("With {}, the most efficient first. Efficiency is 1 / (relMSE x seconds), "
                       "relative to {}: of two unbiased strategies, one with twice the efficiency "
                       "needs half the time for the same error. The number after +- is half the "
                       "95% confidence interval, which is in brackets where it is one of the "
                       "logarithm; not significant: the interval includes 0. Slopes "
                       "are of log error against log samples: -1 for independent samples.",
                       at, results.baseline) +
           missedNote(study, results)));
  fill(page, "table", resultsHtml(study, results));
  fill(page, "pairsNote",
       escaped(fmt::format(
           "Unbiased strategies must agree up to noise. The test is Welch's t-test on each tile of "
           "{0} x {0} pixels with {1}; p is the probability of the largest difference of a tile if "
           "there is only noise, corrected for the number of tiles (Sidak). By chance one of "
           "twenty pairs has p below 0.05. Strategies whose relMSE may be above {2:g}, or whose "
           "mean lacks light that the reference has, are excluded, because they have not sampled "
           "all light yet.",
           Agreement::kTile, at, kMaxNoiseOfPairs)));
  fill(page, "pairs", pairsHtml(results));
  std::string probes;
  for (const auto& [name, directions] : scene.directions) probes += dots(name, directions);
  fill(page, "probes", probes);
  fill(page, "probe", probeUri(*scene.probe));
  fill(page, "exposure", fmt::format("{:g}", scene.exposure));
  fill(page, "command", escaped(machine.command));
  fill(page, "machine",
       escaped(fmt::format("chromeball {}, {}; {}, {} threads; {}; {}.", CHROMEBALL_VERSION,
                           machine.compiler, machine.processor, machine.threads, machine.system,
                           machine.date)));
  fill(page, "method",
       "Strategies alternate (A B C A B C), so that a machine whose speed drifts does not favour "
       "any of them. Seconds are render time alone. Every render has its own seed, and the "
       "reference shares none of them. All numbers are in <code>results.csv</code> and "
       "<code>results.json</code>, all renders in <code>renders/</code>.");
  fill(page, "budget", at);
  fill(page, "data", jsonText(reportImages(store, results)));
  fill(page, "script", kReportScript);
  return page;
}

}  // namespace chromeball
