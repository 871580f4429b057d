#include "report/table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "report/html.hpp"

namespace outrider::report {

std::size_t display_width(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string table_text(const Table& table) {
  std::vector<std::size_t> widths;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    widths.push_back(display_width(table.columns[c]));
    for (const auto& row : table.rows) widths[c] = std::max(widths[c], display_width(row[c]));
  }
  const auto line = [&](const std::vector<std::string>& cells) {
    std::string text;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const std::string padding(widths[c] - display_width(cells[c]), ' ');
      text += c == 0 ? cells[c] + padding : "  " + padding + cells[c];
    }
    text.erase(text.find_last_not_of(' ') + 1);
    return text + '\n';
  };
  std::string text = table.title.empty() ? "" : table.title + '\n';
  text += line(table.columns);
  for (const auto& row : table.rows) text += line(row);
  if (!table.note.empty()) text += table.note + '\n';
  return text;
}

std::string table_html(const Table& table) {
  std::string html = fmt::format("<figure class=\"table\"><figcaption>{}</figcaption>\n<table><thead><tr>",
                                 escape_html(table.title));
  for (const std::string& column : table.columns) html += fmt::format("<th scope=\"col\">{}</th>", escape_html(column));
  html += "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (std::size_t c = 0; c < row.size(); ++c)
      html += c == 0 ? fmt::format("<th scope=\"row\">{}</th>", escape_html(row[c]))
                     : fmt::format("<td>{}</td>", escape_html(row[c]));
    html += "</tr>\n";
  }
  html += "</tbody></table>\n";
  if (!table.note.empty()) html += fmt::format("<p class=\"note\">{}</p>\n", escape_html(table.note));
  return html + "</figure>\n";
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

}  // namespace outrider::report
