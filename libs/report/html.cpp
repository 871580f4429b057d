#include "report/html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "report/assets.hpp"
#include "report/figures.hpp"
#include "report/page_data.hpp"
#include "report/run_folder.hpp"

namespace outrider::report {
namespace {

std::string plain_text(const Json& value) { return value.is_string() ? value.get<std::string>() : to_text(value); }

std::string title(const Json& run) {
  std::string name = run["world"].is_object() ? run["world"].value("name", std::string()) : "";
  if (name.empty()) name = run.value("verb", std::string("run"));
  const std::string coordinator = run.value("coordinator", std::string());
  return coordinator.empty() ? name : name + " — " + coordinator;
}

std::string figures_html(const Json& run) {
  std::string rows;
  for (const FigureRow& row : figure_rows({&run, 1}))
    rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", escape_html(row.label),
                        escape_html(row.values[0]));
  return rows;
}

/// The section on what was left; nothing for runs that do not explore.
std::string left_html(const Json& result) {
  if (!result.contains("left") || !result["left"].is_array()) return "";
  const std::string heading = "<section>\n<h2>What is left, and why</h2>\n";
  if (result["left"].empty()) return heading + "<p>Nothing that is known of.</p>\n</section>\n";
  std::string rows;
  for (const Json& place : result["left"]) {
    const Json at = place.value("frontier", Json());
    const bool point = at.is_array() && at.size() == 2 && at[0].is_number() && at[1].is_number();
    const Json area = place.value("m2", Json());
    rows += fmt::format("<tr><td>{}</td><td class=\"number\">{}</td><td>{}</td></tr>\n",
                        point ? fmt::format("({:.2f}, {:.2f}) m", at[0].get<double>(), at[1].get<double>()) : "",
                        area.is_number() ? fmt::format("{:.2f}", area.get<double>()) : "",
                        escape_html(plain_text(place.value("why", Json("")))));
  }
  return heading +
         "<table class=\"list\"><thead><tr><th>frontier at</th><th class=\"number\">m² behind it</th><th>why</th></tr>"
         "</thead><tbody>\n" +
         rows + "</tbody></table>\n</section>\n";
}

/// The loop closures of a replay, those with the largest residuals first; nothing for other runs.
std::string closures_html(const Json& result) {
  if (!result.contains("slam") || !result["slam"].contains("closures")) return "";
  std::vector<Json> closures = result["slam"]["closures"].get<std::vector<Json>>();
  if (closures.empty()) return "";
  constexpr std::size_t kMost = 200;
  const auto refused = [](const Json& c) { return !c.value("accepted", false); };
  const auto count = std::count_if(closures.begin(), closures.end(), refused);
  std::stable_sort(closures.begin(), closures.end(),
                   [](const Json& a, const Json& b) { return a.value("residual_m", 0.0) > b.value("residual_m", 0.0); });
  std::string html = fmt::format(
      "<section>\n<h2>Loop closures</h2>\n<p>{} believed, {} refused{}. Residual: what the final trajectory leaves of "
      "the measured transform.</p>\n<table class=\"list\"><thead><tr><th>scan at</th><th>seen before at</th>"
      "<th class=\"number\">residual</th><th class=\"number\">points matched</th><th>believed</th></tr></thead>"
      "<tbody>\n",
      closures.size() - static_cast<std::size_t>(count), count,
      closures.size() > kMost ? fmt::format("; the {} with the largest residuals are shown", kMost) : "");
  closures.resize(std::min(closures.size(), kMost));
  for (const Json& c : closures) {
    const std::string why = plain_text(c.value("why", Json("")));
    html += fmt::format("<tr><td>{:.1f} s</td><td>{:.1f} s</td><td class=\"number\">{:.3f} m, {:.2f}°</td>"
                        "<td class=\"number\">{:.0f} %</td><td>{}</td></tr>\n",
                        c.value("t_to", 0.0), c.value("t_from", 0.0), c.value("residual_m", 0.0),
                        c.value("residual_deg", 0.0), 100.0 * c.value("share", 0.0),
                        escape_html(why.empty() ? "yes" : "no: " + why));
  }
  return html + "</tbody></table>\n</section>\n";
}

/// How several logs came together; nothing for other runs.
std::string merge_html(const Json& result) {
  if (!result.contains("merge") || !result["merge"].is_array() || result["merge"].empty()) return "";
  std::string rows;
  for (const Json& m : result["merge"]) {
    const Json T = m.value("transform", Json());
    const bool pose = T.is_array() && T.size() == 3 && T[0].is_number() && T[1].is_number() && T[2].is_number();
    const std::string why = plain_text(m.value("why", Json("")));
    rows += fmt::format(
        "<tr><td>{}</td><td>{}</td><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{:.1f} %</td>"
        "<td class=\"number\">{:.1f} %</td></tr>\n",
        escape_html(plain_text(m.value("robot", Json("")))),
        escape_html((m.value("accepted", false) ? "yes" : "no") + (why.empty() ? "" : ": " + why)),
        pose && m.value("accepted", false) ? fmt::format("({:.2f}, {:.2f}) m, {:.1f}°", T[0].get<double>(),
                                                         T[1].get<double>(), T[2].get<double>() * 180.0 / kPi)
                                           : "",
        m.value("closures", 0), 100.0 * m.value("score", 0.0), 100.0 * m.value("hit_ratio", 0.0));
  }
  return "<section>\n<h2>How the logs came together</h2>\n<table class=\"list\"><thead><tr><th>robot</th><th>merged</th>"
         "<th>starts at</th><th class=\"number\">closures with others</th><th class=\"number\">seen alike</th>"
         "<th class=\"number\">points on walls</th></tr></thead><tbody>\n" + rows + "</tbody></table>\n</section>\n";
}

/// Nested keys as "a.b"; lists on one line.
void flatten(const Json& json, const std::string& prefix, std::string& rows) {
  if (json.is_object() && !json.empty()) {
    for (const auto& [key, value] : json.items()) flatten(value, prefix.empty() ? key : prefix + "." + key, rows);
    return;
  }
  rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", escape_html(prefix),
                      escape_html(plain_text(json)));
}

std::string configuration_html(const Json& run) {
  std::string rows;
  for (const char* key : {"outrider", "seed", "world", "coordinator", "comms"})
    if (run.contains(key) && !run[key].is_null() && run[key] != "") flatten(run[key], key, rows);
  if (run["configuration"].is_object()) flatten(run["configuration"], "", rows);
  for (const Json& robot : run["team"])
    rows += fmt::format("<tr><th scope=\"row\">robot {}</th><td>{}</td></tr>\n", escape_html(plain_text(robot["name"])),
                        escape_html(plain_text(robot)));
  return rows;
}

bool is_shell_safe(const std::string& word) {
  static constexpr std::string_view kSafe = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
  return !word.empty() && word.find_first_not_of(kSafe) == std::string::npos;
}

}  // namespace

std::string escape_html(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string script_json(const Json& json) {
  std::string out;
  for (const char c : to_text(json)) {
    if (c == '<')  // only inside strings, where \u003c means the same
      out += "\\u003c";
    else
      out += c;
  }
  return out;
}

std::string shell_command(const std::vector<std::string>& argv) {
  std::string line;
  for (const std::string& word : argv) {
    if (!line.empty()) line += ' ';
    if (is_shell_safe(word)) {
      line += word;
      continue;
    }
    line += '\'';
    for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += '\'';
  }
  return line;
}

std::string fill_template(std::string_view page, const std::vector<std::pair<std::string, std::string>>& values) {
  std::string out;
  while (true) {
    const std::size_t open = page.find("{{");
    out += page.substr(0, open);
    if (open == std::string_view::npos) return out;
    const std::size_t close = page.find("}}", open);
    assert(close != std::string_view::npos);
    const std::string_view name = page.substr(open + 2, close - open - 2);
    const auto value = std::find_if(values.begin(), values.end(), [&](const auto& v) { return v.first == name; });
    assert(value != values.end());
    if (value != values.end()) out += value->second;
    page.remove_prefix(close + 2);
  }
}

std::string watch_html() {
  return fill_template(watch_template(), {{"style", std::string(style_sheet())},
                                          {"chart_library", std::string(chart_library())},
                                          {"chart_script", std::string(chart_script())},
                                          {"map_script", std::string(map_script())},
                                          {"script", std::string(watch_script())}});
}

std::string report_html(const RunRecord& record) {
  const Json run = run_json(record);
  return fill_template(report_template(), {{"title", escape_html(title(run))},
                                           {"verdict", escape_html(verdict(run))},
                                           {"style", std::string(style_sheet())},
                                           {"figures", figures_html(run)},
                                           {"left", left_html(run["result"]) + merge_html(run["result"]) +
                                                        closures_html(run["result"])},
                                           {"configuration", configuration_html(run)},
                                           {"command", escape_html(shell_command(record.command))},
                                           {"version", escape_html(record.version)},
                                           {"seed", fmt::format("{}", record.seed)},
                                           {"data", script_json(page_data(record, run["result"]))},
                                           {"chart_library", std::string(chart_library())},
                                           {"chart_script", std::string(chart_script())},
                                           {"map_script", std::string(map_script())},
                                           {"script", std::string(report_script())}});
}

}  // namespace outrider::report
