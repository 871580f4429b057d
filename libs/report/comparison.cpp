#include "report/comparison.hpp"

#include <fmt/format.h>

#include <cmath>

#include "report/assets.hpp"
#include "report/figures.hpp"
#include "report/html.hpp"

namespace outrider::report {
namespace {

constexpr std::size_t kMaxRows = 1'000;

Json curve(const RunSummary& run) {
  Json t = Json::array(), fraction = Json::array();
  const std::size_t stride = run.timeline.size() / kMaxRows + 1;
  const double t0 = run.timeline.empty() || run.timeline[0].time_s < 1e6 ? 0.0 : run.timeline[0].time_s;
  for (std::size_t i = 0; i < run.timeline.size(); ++i) {
    if (i % stride != 0 && i + 1 != run.timeline.size()) continue;
    t.push_back(std::round((run.timeline[i].time_s - t0) * 100.0) / 100.0);
    fraction.push_back(run.timeline[i].explored_fraction);
  }
  return {{"name", run.name}, {"t", std::move(t)}, {"fraction", std::move(fraction)}};
}

std::string table_html(std::span<const RunSummary> runs) {
  std::vector<Json> documents;
  std::string html = "<thead><tr><th></th>";
  for (const RunSummary& run : runs) {
    documents.push_back(run.run);
    html += fmt::format("<th scope=\"col\">{}<small>{}</small></th>", escape_html(run.name),
                        escape_html(run.run.value("coordinator", std::string())));
  }
  html += "</tr></thead><tbody>\n";
  for (const FigureRow& row : figure_rows(documents)) {
    html += fmt::format("<tr><th scope=\"row\">{}</th>", escape_html(row.label));
    for (const std::string& value : row.values) html += fmt::format("<td>{}</td>", escape_html(value));
    html += "</tr>\n";
  }
  return html + "</tbody>";
}

std::string commands_html(std::span<const RunSummary> runs) {
  std::string html;
  for (const RunSummary& run : runs) {
    std::vector<std::string> argv;
    for (const Json& word : run.run.value("command", Json::array()))
      if (word.is_string()) argv.push_back(word);
    html +=
        fmt::format("<p>{}</p><pre><code>{}</code></pre>\n", escape_html(run.name), escape_html(shell_command(argv)));
  }
  return html;
}

}  // namespace

Json comparison_json(std::span<const RunSummary> runs) {
  Json list = Json::array();
  for (const RunSummary& run : runs) {
    Json entry{{"run", run.dir.string()}};
    for (const char* key : {"outrider", "command", "seed", "world", "coordinator", "comms", "result"})
      if (run.run.contains(key)) entry[key] = run.run[key];
    list.push_back(std::move(entry));
  }
  return {{"schema", 1}, {"runs", std::move(list)}};
}

std::string comparison_html(std::span<const RunSummary> runs) {
  Json curves = Json::array();
  for (const RunSummary& run : runs)
    if (!run.timeline.empty()) curves.push_back(curve(run));
  return fill_template(comparison_template(), {{"count", fmt::format("{}", runs.size())},
                                               {"style", std::string(style_sheet())},
                                               {"table", table_html(runs)},
                                               {"commands", commands_html(runs)},
                                               {"data", script_json({{"curves", std::move(curves)}})},
                                               {"chart_library", std::string(chart_library())},
                                               {"chart_script", std::string(chart_script())},
                                               {"script", std::string(comparison_script())}});
}

}  // namespace outrider::report
