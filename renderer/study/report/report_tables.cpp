// SPDX-License-Identifier: Apache-2.0
#include "study/report/report_tables.h"

#include <fmt/format.h>

#include <algorithm>

#include "study/report/log_log_plot.h"
#include "study/result_tables.h"

namespace chromeball {
namespace {

std::string plusMinus(const EstimateText& e) {
  if (e.halfInterval == "0") return e.number;
  return fmt::format("{} <span class=\"soft\">&plusmn; {}</span>", e.number, e.halfInterval);
}
std::string plusMinus(const Estimate& e) { return plusMinus(estimateText(e)); }

// For numbers that mean nothing if they may be 0.
std::string significant(const Estimate& e) {
  const EstimateText text = estimateText(e);
  if (text.isSignificant) return plusMinus(text);
  return fmt::format("<span class=\"soft\">not significant &plusmn; {}</span>", text.halfInterval);
}

std::string row(const Cell& cell, const StrategyResult& strategy, double mostEfficient) {
  const double width = 70 * std::max(0.0, cell.efficiency.mean / mostEfficient);
  std::string crossing = "none detected";
  if (strategy.unbiased) crossing = "unbiased";
  if (const auto& c = strategy.biasEqualsNoise)
    crossing = fmt::format("{} <span class=\"soft\">({} to {})</span>", shortNumber(c->samples, 2),
                           shortNumber(c->low, 2), shortNumber(c->high, 2));
  return fmt::format(
      "<tr data-strategy=\"{0}\"><td>{0}</td><td class=\"bars\"><span class=\"bar\" "
      "style=\"width:{1:.0f}px\"></span></td><td>{2}</td><td>{3}</td><td>{4}</td><td>{5:.3f}</"
      "td><td>{6}</td><td>{7}</td><td>{8}</td>"
      "<td>{9}</td></tr>\n",
      escaped(cell.strategy), width, significant(cell.efficiency), significant(cell.error.relMse),
      plusMinus(cell.seconds), cell.prepareSeconds,
      significant({100 * cell.error.bias.mean, 100 * cell.error.bias.standardError}),
      strategy.variance ? plusMinus(strategy.variance->slope) : "",
      strategy.relMse ? plusMinus(strategy.relMse->slope) : "", crossing);
}

}  // namespace

std::string resultsHtml(const Study& study, const StudyResults& results) {
  std::string html =
      "<table "
      "id=\"results\"><thead><tr><th>strategy</th><th></th><th>efficiency</th><th>relMSE</th>"
      "<th>seconds</th><th>preparation,<br>seconds</th><th>bias, %</th><th>slope "
      "of<br>variance</th>"
      "<th>slope of<br>relMSE</th><th>bias = noise<br>at samples</th></tr></thead><tbody>\n";
  const std::vector<const Cell*> cells = ranking(study, results);
  for (const Cell* cell : cells)
    for (const StrategyResult& strategy : results.strategies)
      if (strategy.name == cell->strategy)
        html += row(*cell, strategy, cells.front()->efficiency.mean);
  return html + "</tbody></table>\n";
}

std::string pairsHtml(const StudyResults& results) {
  if (results.pairs.empty()) return "<p>Fewer than two strategies can be compared here.</p>\n";
  std::string html =
      "<table id=\"pairs\"><thead><tr><th>pair</th><th>p</th><th>tiles that differ</th></tr>"
      "</thead><tbody>\n";
  for (const PairResult& pair : results.pairs)
    html += fmt::format("<tr><td>{} and {}</td><td{}>{:.2g}</td><td>{:.2g}%</td></tr>\n",
                        escaped(pair.a), escaped(pair.b),
                        pair.agreement.pValue < 0.05 ? " class=\"fails\"" : "",
                        pair.agreement.pValue, 100 * pair.agreement.fraction);
  return html + "</tbody></table>\n";
}

}  // namespace chromeball
